// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: the content of the files of textured meshes.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "io/textured/textured_mesh.h"
#include "private/only_for_io.h"

namespace axial::io {

// The corners of faces as vertices of their own: one for each vertex, texture and place in it.
struct UnifiedCorners {
  std::vector<std::uint32_t> vertex;                // of the mesh
  std::vector<Eigen::Vector2f> uv;                  // [px]
  std::vector<std::array<std::uint32_t, 3>> faces;  // indices into the two
};

// Of all faces with `texture`, in the order of the mesh.
UnifiedCorners unify_corners(const TexturedMesh& mesh, std::uint32_t texture);

// The texture coordinates of the formats, with v from the upper edge.
Eigen::Vector2f relative(const Eigen::Vector2f& uv, const cv::Size& texture);

std::string textured_ply(const TexturedMesh& mesh, const std::vector<std::string>& textures,
                         const LocalFrame& frame);
std::string textured_obj(const TexturedMesh& mesh, const std::string& materials,
                         const LocalFrame& frame);
std::string textured_mtl(const std::vector<std::string>& textures);

// glTF: `binary` is the name of the file that gets the buffer.
struct GltfFiles {
  std::string json, buffer;
};
GltfFiles textured_gltf(const TexturedMesh& mesh, const std::vector<std::string>& textures,
                        const std::string& binary, const LocalFrame& frame);

// `pngs`: the encoded textures.
std::string textured_glb(const TexturedMesh& mesh, const std::vector<std::string>& pngs,
                         const LocalFrame& frame);

}  // namespace axial::io
