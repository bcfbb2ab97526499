// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: makes the contents of the files of textured meshes, without writing them.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "io/textured/textured_mesh.h"
#include "private/only_for_io.h"

namespace axial::io {

// The corners of the faces that have one texture, without repetitions. Two corners are the same if
// they have the same vertex and the same texture coordinates. Corner i has the vertex `vertex[i]`
// and the texture coordinates `uv[i]`.
struct UnifiedCorners {
  std::vector<std::uint32_t> vertex;                // indices into the vertices of the mesh
  std::vector<Eigen::Vector2f> uv;                  // [px]
  std::vector<std::array<std::uint32_t, 3>> faces;  // indices into `vertex` and `uv`
};

// Returns the corners of all faces with the texture `texture`, in the order of the mesh.
UnifiedCorners unify_corners(const TexturedMesh& mesh, std::uint32_t texture);

// Converts texture coordinates from pixels to ((x + 0.5) / width, (y + 0.5) / height), so that v
// counts from the upper edge. `texture` is the size of the texture.
Eigen::Vector2f relative(const Eigen::Vector2f& uv, const cv::Size& texture);

// Return the bytes of a PLY, OBJ and MTL file. `textures` holds the file names of the textures, and
// `materials` is the name of the MTL file.
std::string textured_ply(const TexturedMesh& mesh, const std::vector<std::string>& textures,
                         const LocalFrame& frame);
std::string textured_obj(const TexturedMesh& mesh, const std::string& materials,
                         const LocalFrame& frame);
std::string textured_mtl(const std::vector<std::string>& textures);

// The two files of a glTF. textured_gltf takes the file names of the textures, and in `binary` the
// name of the file that will hold `buffer`.
struct GltfFiles {
  std::string json, buffer;
};
GltfFiles textured_gltf(const TexturedMesh& mesh, const std::vector<std::string>& textures,
                        const std::string& binary, const LocalFrame& frame);

// Returns the bytes of a GLB file. `pngs` holds the textures, encoded as PNG.
std::string textured_glb(const TexturedMesh& mesh, const std::vector<std::string>& pngs,
                         const LocalFrame& frame);

}  // namespace axial::io
