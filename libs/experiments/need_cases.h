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
  double value;        // of this parameter, in the unit that `series` names; 0: it has no value
  SceneOptions scene;
  // Set if the lens was calibrated in this other scene and is not calibrated again.
  std::optional<SceneOptions> calibrated_in;

  bool is_usual() const { return name == "usual"; }
};

// All cases, the usual one first; the names are unique. `quick`: the usual case, a worse case and
// one second survey, all with small images.
std::vector<NeedCase> need_cases(bool quick);

// A title for the table, such as "tilt 6°".
std::string title_of(const NeedCase& one);

}  // namespace axial::experiments
