// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of the map of where a refractive model is needed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "chain.h"

namespace axial {

struct Case {
  std::string name;    // of the part
  std::string series;  // what is varied
  double value;
  SceneOptions scene;
  // The lens was calibrated in this scene, before, and is not calibrated again.
  std::optional<SceneOptions> calibrated_in;

  bool is_usual() const { return name == "usual"; }
};

// Quick: the usual case, one that is worse, and one second survey, all small.
std::vector<Case> need_cases(bool quick);

// For the reader: "tilt 6 degrees".
std::string title_of(const Case& one);

}  // namespace axial
