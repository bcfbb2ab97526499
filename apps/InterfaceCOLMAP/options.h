// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "base/program/program.h"
#include "io/colmap/colmap_masks.h"

namespace axial::apps {

struct Options {
  ParsedOptions parsed;
  std::filesystem::path colmap_folder;
  std::filesystem::path scene_file;     // output of an import, input of an export
  std::filesystem::path named_output;   // output of an import as the user named it
  std::filesystem::path export_folder;  // output of an export; empty: import
  // The folder of the images, which exists. Empty in an export: the common folder of the images.
  std::filesystem::path image_folder;
  // A folder that --image-folder could mean, too, and that is not used. Empty: there is none.
  std::filesystem::path other_image_folder;
  std::filesystem::path housing_file;  // empty: no housing
  // Masks of photographs to write for COLMAP; `masks.masks` is empty in an import and an export.
  io::ColmapMasks masks;
  std::filesystem::path point_cloud;  // for an export; empty: the scene's own points
  bool allow_missing =
      false;  // images that are missing, and a housing without images, are left out
  bool normalize = false;
  std::optional<bool> undistort;  // empty: only if no image is behind a port
};

// Parses and checks the command line. Error for an unknown option and for a wrong value.
// `parsed.run` is false if nothing is left to do, for example after --help.
Options parse_command_line(int argc, const char* const* argv);

}  // namespace axial::apps
