// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "base/program.h"

namespace axial::apps {

struct Options {
  ParsedOptions parsed;
  std::filesystem::path colmap_folder;
  std::filesystem::path scene_file;     // output of an import, input of an export
  std::filesystem::path export_folder;  // empty: import
  std::filesystem::path image_folder;   // exists; empty in an export: the images' common folder
  std::filesystem::path other_image_folder;  // another folder of that name, not used; may be empty
  std::filesystem::path housing_file;        // empty: no housing
  std::filesystem::path point_cloud;         // for an export; empty: the scene's own points
  bool allow_missing = false;                // go on if the housing gives no image a port
  bool normalize = false;
  std::optional<bool> undistort;  // empty: only if no image is behind a port
};

// Parses and checks the command line. `parsed.run` is false if nothing is left to do.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
