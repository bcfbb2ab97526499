// SPDX-License-Identifier: GPL-3.0-or-later
// OpenMVS depth maps (.dmap), with a side file that describes their camera.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "axial/base.h"
#include "scene/depth_map.h"

namespace axial::io {

// A depth map that is stored in a .dmap file and a side file "<path>.json".
//
// The .dmap file holds the z-depth [m], the normals in the camera frame, the matrix K of the lens
// in air, and the pose. The side file holds the camera model with its port, the text `made_from`,
// and a fingerprint of the bytes of the .dmap file. `made_from` is a text of the caller that
// identifies the inputs and options from which the depth map was made, such as a fingerprint of
// them. The fingerprint of the bytes shows whether the .dmap file is damaged or was written by
// another program. Without a side file the camera counts as a pinhole and `made_from` is empty.
//
// Depth in memory is lambda (see DepthMap). The functions below convert between z-depth in the file
// and lambda in memory.
struct StoredDepthMap {
  DepthMap map;
  std::string made_from;
};

// Whether the side file is read. `ignored`: the camera counts as a pinhole even if there is a side
// file. Use this value if another program has replaced the depth map that belongs to the side file.
enum class DmapSide { used, ignored };

// Reads a depth map and converts its z-depth to lambda. If the file has no normals, `normal` is
// zero everywhere. If it has no confidences, `confidence` is empty. The camera is that of the side
// file. If there is no side file or `side` is `ignored`, the camera is a pinhole without a port and
// has the K of the .dmap file. Image paths in the file are relative to the folder of the file, and
// absolute in the result. Error for a truncated or malformed file, sizes that disagree, depths that
// are negative or not finite (0 means no depth), or a side file that belongs to another depth map.
// Warns through `context` of a port's normal in the side file that is not of unit length.
StoredDepthMap read_dmap(const std::filesystem::path& path, DmapSide side = DmapSide::used,
                         const Context& context = {});

// Reads a depth map without its pixels: `depth`, `normal` and `confidence` stay empty. The size of
// the map is that of its camera. The fingerprint of the .dmap file is not checked. Warnings and
// errors as for read_dmap(), except for wrong pixels and a wrong fingerprint. In addition, an Error
// for a file whose length disagrees with its header.
DepthMap read_dmap_header(const std::filesystem::path& path, DmapSide side = DmapSide::used,
                          const Context& context = {});

// Writes a depth map and its side file. First an existing depth map at `path` is removed. Then the
// side file is replaced. Last the new depth map is renamed to `path`. Because of this order, an
// interruption never leaves a depth map beside the side file of another depth map. `made_from` is
// the text that read_dmap() returns later. Error for an empty map, arrays of different sizes or of
// another size than the camera, a map without ids, a depth whose point is not in front of the
// camera, or a file that cannot be written.
void write_dmap(const std::filesystem::path& path, const DepthMap& map,
                const std::string& made_from);

// Returns an upper bound of the memory [bytes] that read_dmap() or write_dmap() needs for a map of
// `pixels` pixels. The memory of the map itself is not included. The bound counts the bytes of the
// file and the converted depths.
constexpr std::uint64_t dmap_bytes_needed(std::uint64_t pixels) {
  return 44 * pixels;
}

// Which program wrote a depth map. "Ours" are the depth maps of write_dmap().
enum class DmapOrigin {
  none,     // there is no depth map
  ours,     // the depth map has the fingerprint in its side file
  damaged,  // there is a side file, but the depth map or the side file is incomplete
  foreign   // no side file, or an undamaged depth map with another fingerprint
};

// The result of dmap_status().
struct DmapStatus {
  DmapOrigin origin = DmapOrigin::none;
  std::string made_from;  // empty unless `origin` is `ours`

  // Whether the depth map is ours and has this text `made_from`.
  bool is_ours_from(const std::string& text) const {
    return origin == DmapOrigin::ours && made_from == text;
  }
};

// Tells whether AxialMVS or another program wrote the depth map at `path`, and whether the depth
// map is damaged. If there is a side file, the whole depth map is read to compare its fingerprint.
// A file that cannot be read counts as damaged. Warnings as for read_dmap().
DmapStatus dmap_status(const std::filesystem::path& path, const Context& context = {});

}  // namespace axial::io
