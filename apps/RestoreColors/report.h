// SPDX-License-Identifier: GPL-3.0-or-later
// What was found about the water and the light.
#pragma once

#include <filesystem>

#include "color/brightness.h"
#include "color/camera_curve.h"
#include "color/chart.h"
#include "color/daylight.h"
#include "color/exposure.h"
#include "color/restore.h"
#include "options.h"

namespace axial::apps {

// What gives white.
enum class White { grey_seabed, grey_part, charts };

// A colour chart in a photograph.
struct SeenChart {
  std::string photograph;     // survey::photograph_names()
  color::PatchLights lights;  // restored, without gain
  Eigen::Array3f gain;        // by this chart alone
  double error = 0;           // chart_error() with Findings::gain
};

struct Findings {
  color::Choice choice;
  bool light_given = false;
  color::Transfer transfer;                       // the curve of the camera
  bool curve_given = false;                       // by --curve
  std::optional<color::CameraCurve> found_curve;  // if it was looked for by exposures
  std::size_t points = 0, observations = 0;
  double raw_spread = 0, spread = 0;  // of a point's light between photographs
  double unevenness = 0;              // by the place in the image, after restoring
  double known = 0;                   // share of pixels whose colour is determined
  ExposureKind exposure = ExposureKind::one;
  // Of the views; 1 for all if they have one. `exposures_left`: by how much they differ from those.
  color::Exposures exposures;
  double exposures_left = 0;
  Eigen::Array3f gain = Eigen::Array3f::Ones();
  White white = White::grey_seabed;
  std::vector<SeenChart> charts;
  std::optional<color::Daylight> daylight;  // in daylight
  std::vector<color::BrightnessAt> brightness;
};

// Logs the findings, and warns of channels that are not determined.
void log_findings(const Findings& findings, const Context& context);

// Writes <folder>/colors.json (docs/formats.md, "Colours without water").
void write_findings(const std::filesystem::path& folder, const Findings& findings);

}  // namespace axial::apps
