// SPDX-License-Identifier: GPL-3.0-or-later
// OpenMVS depth maps (.dmap), with a side file that describes their camera.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "scene/depth_map.h"

namespace axial::io {

// A .dmap file holds z-depth and normals in the camera frame, and the in-air K and the pose. The
// side file "<path>.json" holds the camera model with its port, `made_from`, which is a fingerprint
// of the inputs and options, and a fingerprint of the .dmap file. The last one shows whether the
// depth map is damaged or was written by another program. Without a side file the camera counts as
// a pinhole and `made_from` is empty. In memory depth is lambda (see DepthMap). The functions below
// convert between z-depth and lambda.
struct StoredDepthMap {
  DepthMap map;
  std::string made_from;
};

// `ignored`: the camera counts as a pinhole even if there is a side file. This is for depth maps of
// another program that replaced our own.
enum class DmapSide { used, ignored };

// Reads a depth map and converts its z-depth to lambda with the camera of the side file, or with
// the K of the .dmap file and no port. Error for a truncated or malformed file, sizes that
// disagree, depths that are not positive, or a side file that belongs to another depth map.
StoredDepthMap read_dmap(const std::filesystem::path& path, DmapSide side = DmapSide::used);

// Reads a depth map without its pixels: `depth`, `normal` and `confidence` stay empty. The
// fingerprint in the side file is not checked. Errors as for read_dmap, and for a file whose length
// disagrees with its header.
DepthMap read_dmap_header(const std::filesystem::path& path, DmapSide side = DmapSide::used);

// Writes a depth map and its side file. An existing depth map at `path` is removed first, then the
// side file is replaced, and last the new depth map gets its name. No depth map is therefore ever
// beside the side file of another depth map, even if the program is interrupted. `made_from` is the
// text that read_dmap returns later. Error for an empty map, arrays of different sizes, a map
// without ids, or a depth that is not in front of the camera.
void write_dmap(const std::filesystem::path& path, const DepthMap& map,
                const std::string& made_from);

// An upper bound of the memory [bytes] of read_dmap() and write_dmap() for a map of `pixels`
// pixels, without the map itself: the bytes of the file, and converted depths.
constexpr std::uint64_t dmap_bytes_needed(std::uint64_t pixels) {
  return 44 * pixels;
}

enum class DmapOrigin {
  none,     // no such file
  ours,     // matches its side file
  damaged,  // has a side file, but the map or the side file is incomplete
  foreign   // has no side file, or is complete but does not match its side file
};

struct DmapStatus {
  DmapOrigin origin = DmapOrigin::none;
  std::string made_from;  // of ours
};

// Tells who wrote the file at `path`. If there is a side file, the whole depth map is read.
DmapStatus dmap_status(const std::filesystem::path& path);

// Returns `made_from` of the side file if the depth map exists and matches it (DmapOrigin::ours).
std::optional<std::string> dmap_made_from(const std::filesystem::path& path);

}  // namespace axial::io
