// SPDX-License-Identifier: GPL-3.0-or-later
// What was found about the water and the light.
#pragma once

#include <filesystem>

#include "color/restore.h"
#include "options.h"

namespace axial::apps {

struct Findings {
  color::Choice choice;
  bool light_given = false;
  std::size_t points = 0, observations = 0;
  double raw_spread = 0, spread = 0;  // of a point's light between photographs
  double known = 0;                   // share of pixels whose colour is determined
  Eigen::Array3f gain = Eigen::Array3f::Ones();
  bool grey_given = false;
};

// Logs the findings, and warns of channels that are not determined.
void log_findings(const Findings& findings, const Context& context);

// Writes <folder>/colors.json (docs/formats.md, "Colours without water").
void write_findings(const std::filesystem::path& folder, const Findings& findings);

}  // namespace axial::apps
