// SPDX-License-Identifier: GPL-3.0-or-later
// OpenMVS depth maps (.dmap) with the side file that says which camera they belong to.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "scene/depth_map.h"

namespace axial::io {

// A .dmap holds z-depth in the camera frame, normals in the camera frame, and the in-air K and
// pose. The side file "<path>.json" holds the camera model (port included) and `made_from`, a
// fingerprint of the inputs and options; without one the map counts as pinhole and `made_from` is
// empty. It also holds a fingerprint of the map's bytes: a damaged or foreign map is told from the
// one it was written with. In memory depth is lambda (see DepthMap): it is converted here, at the
// file boundary.
struct StoredDepthMap {
  DepthMap map;
  std::string made_from;
};

// The camera model used for the conversion is the side file's, or the file's K without a port.
// Error for truncated or malformed files, sizes that disagree, or a side file of another map.
StoredDepthMap read_dmap(const std::filesystem::path& path);

// The side file takes its place just before the map. `made_from`: what read_dmap returns later.
void write_dmap(const std::filesystem::path& path, const DepthMap& map,
                const std::string& made_from);

// `made_from` of the side file of `path`, if both files exist and belong together.
std::optional<std::string> dmap_made_from(const std::filesystem::path& path);

}  // namespace axial::io
