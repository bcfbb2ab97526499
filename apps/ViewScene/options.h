// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>

#include "axial/survey.h"
#include "base/program/program.h"
#include "depth_maps.h"
#include "maps.h"

namespace axial::apps {

struct Options {
  ParsedOptions parsed;
  survey::Options survey;
  std::filesystem::path cloud, mesh;  // empty: none
  std::filesystem::path report;       // the folder to write
  MapOptions maps;
  DepthMapOptions depth_maps;
  std::filesystem::path run;        // file of a run of `reconstruct`; empty: none
  std::filesystem::path sfm_model;  // folder of a COLMAP model, for residuals; empty: none
  std::filesystem::path truth;      // true mesh, for distances of the cloud; empty: none
  std::uint64_t max_points = 10'000'000;
  int texture_size = 4096;  // longest side of the reduced textures [px]
};

// Parses and checks the command line. Error for an unknown option and for a value out of range.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
