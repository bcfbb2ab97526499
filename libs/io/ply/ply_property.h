// SPDX-License-Identifier: GPL-3.0-or-later
// Additional float properties of the vertices of a PLY file.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/ply/ply.h"

namespace axial::io {

// Reads the property `name` of the vertices. Returns one value for each vertex, in the order of the
// file, converted from the type in the file. The result is empty if the vertices have no property
// of this name, or if the property is a list. Error that names the file for a malformed file, and
// for one that is truncated before the end of its vertices.
std::vector<float> read_vertex_property(const std::filesystem::path& path, const std::string& name);

// A property to write.
struct VertexProperty {
  std::string name;               // without blanks
  std::span<const float> values;  // one for each vertex
};

// Writes a mesh as write_mesh_ply in ply.h does, and adds one float property to the vertices.
// Errors as for that function. In addition, an Error if the number of values differs from the
// number of vertices.
void write_mesh_ply(const std::filesystem::path& path, const Mesh& mesh,
                    const VertexProperty& property, const PlyPlacement& placement = {});

}  // namespace axial::io
