// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of our own at the vertices of a PLY file, by name.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/ply.h"

namespace axial::io {

// One a vertex, in the file's order, as float; empty where the file's vertices have no such
// property or it is a list. Errors as read_cloud_ply.
std::vector<float> read_vertex_property(const std::filesystem::path& path, const std::string& name);

struct VertexProperty {
  std::string name;
  std::span<const float> values;  // one a vertex
};

// As write_mesh_ply, with a float property behind the others of a vertex. Error for another number
// of values than vertices.
void write_mesh_ply(const std::filesystem::path& path, const Mesh& mesh,
                    const VertexProperty& property, const PlyPlacement& placement = {});

}  // namespace axial::io
