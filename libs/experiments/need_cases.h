// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of the table that shows where a refractive model is needed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/chain.h"

namespace axial::experiments {

// A scene that differs from the usual case in one parameter, or is another scene.
struct NeedCase {
  // Name of the part (Part::name): the parameter, with its unit if any, and its value:
  // "tilt_degrees_6". Without a parameter: "usual", or the preset.
  std::string name;
  SceneOptions scene;
  // The scene in which the lens is calibrated. Empty: the lens is calibrated in `scene`.
  std::optional<SceneOptions> calibrated_in;
};

// Returns all cases. The usual case comes first. The names are unique. `quick`: only three cases,
// all with small images and few views: the usual case, the case with the largest tilt, and one case
// whose lens is calibrated in another scene.
std::vector<NeedCase> need_cases(bool quick);

}  // namespace axial::experiments
