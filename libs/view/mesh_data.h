// SPDX-License-Identifier: GPL-3.0-or-later
// The form in which a mesh is written for the viewer (apps/ViewScene/page/src/mesh.js reads it).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "axial/scene_images.h"
#include "scene/mesh.h"

namespace axial::view {

// A part of a mesh as bytes. Numbers are little-endian. `bytes` consists of these arrays:
//   - 3 `vertices` float: positions
//   - 3 `faces` uint32: the vertices of the faces
//   - 2 `vertices` uint16, if the part has a texture: u and v as fractions of the texture's width
//     and height, from its upper left corner: value / 65535
//   - 3 `vertices` uint8, if the part has colours: red, green, blue
struct MeshPart {
  std::size_t vertices = 0, faces = 0;
  int texture = -1;  // index into TexturedMesh::textures; -1: none
  bool colors = false;
  std::string bytes;
};

// Divides the mesh into parts of at most `largest` faces. All faces of a part have the same
// texture. A vertex whose faces have different texture coordinates occurs several times.
std::vector<MeshPart> mesh_parts(const TexturedMesh& mesh, std::size_t largest);

// The colour of marked faces: that of faces without a view in a texture.
inline constexpr Rgb kUnseenColor{255, 127, 39};

// The same for a mesh without textures. The parts have the colours of the vertices, if there are
// any. Marked faces (Mesh::unseen) are in parts of their own, whose vertices all have the colour
// kUnseenColor.
std::vector<MeshPart> mesh_parts(const Mesh& mesh, std::size_t largest);

}  // namespace axial::view
