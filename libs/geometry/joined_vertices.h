// SPDX-License-Identifier: GPL-3.0-or-later
// Faces that share their vertices, as the neighbourhood of a vertex needs it.
#pragma once

#include "scene/mesh.h"

namespace axial::geometry {

// Lets all faces use one vertex of those at the same place, the one with the lowest index. Textured
// meshes have several vertices at the seams of their textures, and some programs write three for
// each face. The vertices stay as they are; some may then have no face. Takes 8 bytes for each
// vertex. Precondition: the vertices are finite, and the vertices of the faces exist.
void join_vertices(Mesh& mesh);

}  // namespace axial::geometry
