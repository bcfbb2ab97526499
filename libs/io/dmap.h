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

// `ignored`: the map counts as a pinhole's whatever lies beside it, for maps that another program
// wrote over one of ours.
enum class DmapSide { used, ignored };

// The camera model used for the conversion is the side file's, or the file's K without a port.
// Error for truncated or malformed files, sizes that disagree, or a side file of another map.
StoredDepthMap read_dmap(const std::filesystem::path& path, DmapSide side = DmapSide::used);

// The same without pixels: `depth`, `normal` and `confidence` stay empty, and the side file is not
// compared with the map's bytes. Error also for a file that is shorter or longer than its header
// says.
DepthMap read_dmap_header(const std::filesystem::path& path, DmapSide side = DmapSide::used);

// A map that lies at `path` already takes its leave and the side file its place just before the new
// map takes its own: at no time is there a map beside a side file of another one. `made_from`: what
// read_dmap returns later.
void write_dmap(const std::filesystem::path& path, const DepthMap& map,
                const std::string& made_from);

enum class DmapOrigin {
  none,     // no such file
  ours,     // as its side file describes it
  damaged,  // has a side file, but either of the two is incomplete
  foreign   // whole or not, without a side file; or whole, and another one than its side file says
};

struct DmapStatus {
  DmapOrigin origin = DmapOrigin::none;
  std::string made_from;  // of ours
};

// Who wrote the file at `path`. Reads it whole where there is a side file.
DmapStatus dmap_status(const std::filesystem::path& path);

// `made_from` of the side file of `path`, if both files exist and belong together.
std::optional<std::string> dmap_made_from(const std::filesystem::path& path);

}  // namespace axial::io
