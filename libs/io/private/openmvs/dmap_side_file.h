// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: the file beside a .dmap file that describes its camera (see dmap.h).
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "private/only_for_io.h"
#include "scene/camera_model.h"

namespace axial::io {

struct DmapSideFile {
  CameraModel camera;                  // at the depth map's resolution
  float min_depth = 0, max_depth = 0;  // lambda [m]
  std::string made_from;
  std::string content;  // Fingerprint of the .dmap's bytes
};

std::filesystem::path dmap_side_path(const std::filesystem::path& dmap);

// Reads the side file of the depth map `dmap`. Returns nothing if there is no side file. Error if
// the side file is malformed.
std::optional<DmapSideFile> read_dmap_side_file(const std::filesystem::path& dmap);

void write_dmap_side_file(const std::filesystem::path& dmap, const DmapSideFile& side);

}  // namespace axial::io
