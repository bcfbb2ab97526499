// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of the table that shows where a refractive model is needed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/chain.h"

namespace axial::experiments {

// A scene, and the parameter in which the scene differs from the usual case.
struct NeedCase {
  std::string name;    // name of the part
  std::string series;  // name of the varied parameter
  double value;        // of the parameter, in the unit in `series`; 0 if the parameter has no value
  SceneOptions scene;
  // The scene in which the lens is calibrated. Empty: the lens is calibrated in `scene`.
  std::optional<SceneOptions> calibrated_in;

  bool is_usual() const { return name == "usual"; }
};

// Returns all cases. The usual case is the first. The names are unique. `quick`: only the usual
// case, the case with the largest tilt, and one second survey, all with small images and few views.
std::vector<NeedCase> need_cases(bool quick);

// A title for the table, such as "tilt 6°".
std::string title_of(const NeedCase& one);

}  // namespace axial::experiments
