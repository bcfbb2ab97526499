// SPDX-License-Identifier: GPL-3.0-or-later
// Reads clouds and meshes that belong to a scene, also those that lost their offset. Users name
// these files with the options -p and -m of OpenMVS's programs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "axial/base.h"
#include "axial/scene_images.h"
#include "io/openmvs/mvs_counts.h"
#include "io/ply/ply.h"
#include "io/textured/textured_mesh.h"
#include "scene/local_frame.h"
#include "scene/mesh.h"
#include "scene/point_cloud.h"
#include "scene/scene.h"

namespace axial::io {

// Read a cloud (PLY) or a mesh (PLY, OBJ, GLB or glTF: read_shape() in io/textured) that belongs to
// a scene in `frame`. The positions of the result are in `frame`.
//
// If the file has a comment geo_offset (in glTF, a key geo_offset), the point in this comment is
// the origin of the stored positions. A comment geo_offset 0 0 0 counts as no comment. Without a
// comment the frame of the stored positions is guessed, because OpenMVS's programs write
// coordinates in the frame of their input but drop the comment geo_offset. The guess is that
// of is_without_offset(), and a line of `context` states it if it is `frame`.
//
// Errors as for read_cloud_ply and read_shape.
PointCloud read_cloud_of_scene(const LocalFrame& frame, const std::filesystem::path& ply,
                               const Context& context = {});
Mesh read_mesh_of_scene(const LocalFrame& frame, const std::filesystem::path& mesh,
                        const Context& context = {});

// Reads a cloud of any size in portions (read_cloud_portions() in io/ply/ply.h), with the positions
// of read_cloud_of_scene().
void read_cloud_of_scene_in_portions(const LocalFrame& frame, const std::filesystem::path& ply,
                                     std::size_t points, const CloudPortionSink& sink,
                                     const Context& context = {});

// An estimate of the memory [bytes] that read_cloud_of_scene() needs, with its result. The estimate
// is made from the size and the header of the file, and is 0 if the header cannot be read or does
// not fit the size.
std::uint64_t bytes_to_read_cloud(const std::filesystem::path& ply);

// Replaces the sparse points of `scene`, with their normals and colours, by the cloud of
// read_cloud_of_scene(). `scene` is in `frame`. The cloud must have the property view_indices,
// which holds indices of the scene's images. The property view_weights is optional: without it all
// confidences are 0. A line of `context` states the number of points.
//
// Error that names the file for a cloud without view_indices, an index of an image that the scene
// does not have, or a point that is not finite. Other errors as for read_cloud_ply.
void use_point_cloud(Scene& scene, const LocalFrame& frame, const std::filesystem::path& ply,
                     const Context& context = {});

// The result of count_point_cloud().
struct PointSourceCounts {
  MvsCounts scene;                  // after use_point_cloud()
  std::uint64_t reading_bytes = 0;  // lower bound of the memory that use_point_cloud needs [bytes]
};

// Estimates the counts of a scene after use_point_cloud, from the header and the size of the file
// `ply`. `scene` holds the counts of the scene before. MvsCounts::observations of the result is 0
// if it cannot be computed: for an ascii PLY, for a PLY with other elements than vertices, and for
// a PLY with other lists than view_indices and view_weights. Returns nothing for a file that cannot
// be read and for a malformed file. In these cases use_point_cloud reports the reason.
std::optional<PointSourceCounts> count_point_cloud(const std::filesystem::path& ply,
                                                   const MvsCounts& scene);

// Reads a mesh with its textures as read_textured_mesh() does (io/textured/textured_mesh.h). The
// frame of the positions is that of read_mesh_of_scene(), which reads the shape alone.
TexturedMesh read_textured_mesh_of_scene(const LocalFrame& frame, const std::filesystem::path& path,
                                         const Context& context = {});

}  // namespace axial::io
