// SPDX-License-Identifier: GPL-3.0-or-later
// A cloud in place of a scene's sparse points: what -p of OpenMVS's programs gives.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "io/mvs_counts.h"
#include "scene/local_frame.h"
#include "scene/scene.h"

namespace axial::io {

// Replaces points, normals and colours of a scene in `frame`. The cloud counts from where its
// comment geo_offset says. Without such a comment it is in the world or in `frame`, whichever is
// nearer to it: OpenMVS's programs keep coordinates and drop comments. The cloud is a PLY with
// view_indices, images of the scene, and view_weights if it has them. Error that names the file for
// a cloud without views, a view of an image that the scene does not have, or a point that is not
// finite.
void use_point_cloud(Scene& scene, const LocalFrame& frame, const std::filesystem::path& ply);

struct PointSourceCounts {
  MvsCounts scene;                  // with the cloud's points in place of its own
  std::uint64_t reading_bytes = 0;  // at least, in memory, while use_point_cloud is at work
};

// From the cloud's header and size alone; `scene` as counted before. Of a PLY in text, or with
// other lists or elements, views do not count. Nothing for a file that cannot be read or is
// malformed: use_point_cloud says what is wrong with it.
std::optional<PointSourceCounts> count_point_cloud(const std::filesystem::path& ply,
                                                   const MvsCounts& scene);

}  // namespace axial::io
