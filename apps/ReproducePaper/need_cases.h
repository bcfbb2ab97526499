// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of the table that shows where a refractive model is needed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "chain.h"

namespace axial {

struct Case {
  std::string name;    // name of the part
  std::string series;  // name of the varied parameter
  double value;
  SceneOptions scene;
  // Set if the lens was calibrated in this other scene and is not calibrated again.
  std::optional<SceneOptions> calibrated_in;

  bool is_usual() const { return name == "usual"; }
};

// `quick`: the usual case, a worse case and one second survey, all with small images.
std::vector<Case> need_cases(bool quick);

// A title for the table, such as "tilt 6 degrees".
std::string title_of(const Case& one);

}  // namespace axial
