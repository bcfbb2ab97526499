// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "base/program.h"

struct Options {
  axial::ParsedOptions parsed;
  std::filesystem::path colmap_folder;
  std::filesystem::path scene_file;          // output, and the input of an export
  std::filesystem::path export_folder;       // empty: import
  std::filesystem::path image_folder;        // exists; empty in an export: that of the images
  std::filesystem::path other_image_folder;  // of the same name, and passed over; may be empty
  std::filesystem::path housing_file;        // empty: no housing
  std::filesystem::path point_cloud;         // of an export; empty: the scene's own points
  bool allow_missing = false;                // go on with a housing that gives no image a port
  bool normalize = false;
  std::optional<bool> undistort;  // nothing: in air
};

// Parses and checks the command line; what is left to do is in `parsed.run`.
Options parse_command_line(int argc, const char* const* argv);
