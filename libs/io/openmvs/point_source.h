// SPDX-License-Identifier: GPL-3.0-or-later
// Clouds and meshes that belong to a scene, as the options -p and -m of OpenMVS's programs name
// them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "io/openmvs/mvs_counts.h"
#include "scene/local_frame.h"
#include "scene/mesh.h"
#include "scene/point_cloud.h"
#include "scene/scene.h"

namespace axial::io {

// Read the PLY file of a cloud or a mesh of a scene whose coordinates are in `frame`; the result is
// in `frame`. If the file has a comment geo_offset, that is the origin of its positions. Otherwise
// its positions are in the world or in `frame`, whichever origin is nearer to its first point,
// because OpenMVS's programs keep coordinates but drop comments. Errors as for read_cloud_ply and
// read_mesh_ply.
PointCloud read_cloud_of_scene(const LocalFrame& frame, const std::filesystem::path& ply);
Mesh read_mesh_of_scene(const LocalFrame& frame, const std::filesystem::path& ply);

// Replaces the points, normals and colours of `scene` by those of read_cloud_of_scene(). The cloud
// must have view_indices, which are indices of the scene's images, and may have view_weights.
//
// Error that names the file for a cloud without views, a view of an image that the scene does not
// have, or a point that is not finite.
void use_point_cloud(Scene& scene, const LocalFrame& frame, const std::filesystem::path& ply);

struct PointSourceCounts {
  MvsCounts scene;                  // with the points of the cloud
  std::uint64_t reading_bytes = 0;  // lower bound of the memory that use_point_cloud needs
};

// Counts from the header and the size of the cloud's file; `scene` holds the counts of the scene.
// Observations are 0 for an ascii PLY and for a PLY with other lists or elements. Nothing for a
// file that cannot be read or is malformed; use_point_cloud reports the reason.
std::optional<PointSourceCounts> count_point_cloud(const std::filesystem::path& ply,
                                                   const MvsCounts& scene);

}  // namespace axial::io
