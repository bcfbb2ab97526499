// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of the table that shows where a refractive model is needed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/chain.h"

namespace axial::experiments {

// A scene, and the parameter in which it differs from the usual one.
struct NeedCase {
  std::string name;    // name of the part
  std::string series;  // name of the varied parameter
  double value;        // of this parameter, in the unit in its name; 0 if it has no value
  SceneOptions scene;
  // The other scene in which the lens was calibrated. Nothing: the lens is calibrated in `scene`.
  std::optional<SceneOptions> calibrated_in;

  bool is_usual() const { return name == "usual"; }
};

// Returns all cases. The usual case is the first. The names are unique. `quick`: only the usual
// case, the case with the largest tilt, and one second survey, all with small images and few views.
std::vector<NeedCase> need_cases(bool quick);

// A title for the table, such as "tilt 6°".
std::string title_of(const NeedCase& one);

}  // namespace axial::experiments
