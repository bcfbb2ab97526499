// SPDX-License-Identifier: GPL-3.0-or-later
// PLY clouds and meshes: ascii and binary in, binary little-endian out.
#pragma once

#include <filesystem>

#include "scene/mesh.h"
#include "scene/point_cloud.h"

namespace axial::io {

// Properties are looked up by name (x y z, nx ny nz, red green blue or diffuse_*, view_indices,
// view_weights); legacy (float, uchar) and modern (float32, uint8) type names; unknown elements and
// properties are skipped. Error that names the file for anything malformed or truncated.
PointCloud read_cloud_ply(const std::filesystem::path& path);

// Layout as OpenMVS writes it: x y z, red green blue, nx ny nz, view_indices, view_weights; each
// group only where the cloud has it. Error if a point has more than 255 views (the format counts in
// a byte).
void write_cloud_ply(const std::filesystem::path& path, const PointCloud& cloud,
                     bool with_views = true);

// Faces of more than three corners are split into a fan. Error for a face index out of range.
Mesh read_mesh_ply(const std::filesystem::path& path);

void write_mesh_ply(const std::filesystem::path& path, const Mesh& mesh);

// True if the header declares a non-empty face element.
bool ply_has_faces(const std::filesystem::path& path);

}  // namespace axial::io
