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
  std::string name;    // name of the part (Part::name)
  std::string series;  // name of the varied parameter, with its unit if any: "tilt_degrees"
  double value;        // of the parameter, in the unit in `series`; 0 if the parameter has no value
  SceneOptions scene;
  // The scene in which the lens is calibrated. Empty: the lens is calibrated in `scene`.
  std::optional<SceneOptions> calibrated_in;

  bool is_usual() const { return name == "usual"; }
};

// Returns all cases. The usual case comes first. The names are unique. `quick`: only three cases,
// all with small images and few views: the usual case, the case with the largest tilt, and one case
// whose lens is calibrated in another scene.
std::vector<NeedCase> need_cases(bool quick);

}  // namespace axial::experiments
