// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "axial/survey.h"
#include "base/program/program.h"
#include "color/daylight.h"
#include "color/observations.h"
#include "color/restore.h"

namespace axial::apps {

// The exposures and white balances of the photographs. `one`: the same of both for all. `given`:
// the exposures are those of a file, and the white balance is the same for all. `each`: both are
// estimated for each photograph.
enum class ExposureKind { one, given, each };

// A part of a photograph that is grey in white light.
struct GreyPatch {
  std::string image;  // the end of the photograph's path
  cv::Rect part;      // [px]
};

struct Settings {
  survey::Options survey;
  std::filesystem::path mesh, output;
  std::optional<color::Light> light;     // empty: by the photographs
  std::optional<color::Transfer> curve;  // empty: by the exposures, or that of sRGB
  ExposureKind exposure = ExposureKind::one;
  std::filesystem::path exposures;  // file of ExposureKind::given
  std::optional<GreyPatch> grey;
  // "all", or the end of the path of a photograph that shows a chart; empty: none is looked for.
  std::string chart;
  color::ObserveOptions observe;
  std::optional<color::WaterType> assumed;  // the type of water, if it is known
  std::optional<Eigen::Vector3d> up;        // of heights; empty: not given
  int jpeg_quality = 95;
  bool masks = false;  // write masks of pixels that are not determined
};

struct Options {
  ParsedOptions parsed;
  Settings settings;
};

// Parses and checks the command line.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
