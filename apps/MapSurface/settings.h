// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "axial/survey.h"
#include "base/program/program.h"
#include "boundary/options.h"
#include "map/height_error.h"
#include "map/map_copies.h"

namespace axial::apps {

struct Settings {
  survey::Options survey;
  std::filesystem::path mesh;
  std::filesystem::path output;       // the names of the maps without ".dem.tif" and so on
  std::optional<Eigen::Vector3d> up;  // in the world; empty: see place_map() in main.cpp
  boundary::Options boundary;
  double pixel = 0;  // of the map [m]; 0: from the photographs
  int epsg = 0;      // 0: no coordinate reference system
  bool hillshade = false;
  double image_noise =
      map::kDefaultNoise;          // for the expected errors of heights [px]; 0: no map of them
  double contours = 0;             // height between contour lines [m]; 0: none
  std::filesystem::path profiles;  // lines; empty: none
  map::CopyOptions copies;
};

struct Options {
  ParsedOptions parsed;
  Settings settings;
};

// Parses and checks the command line. Error for an unknown option and for a value out of range.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
