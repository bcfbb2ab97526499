// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: the default scene of a glTF, as a list of meshes in their places.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bytes/private/only_for_io.h"
#include "textured/private/gltf_file.h"
#include "textured/private/texture_set.h"

namespace axial::io {

// A primitive of triangles. The numbers are those of accessors.
struct GltfPrimitive {
  std::string name;      // "meshes[0].primitives[1]"
  std::size_t mode = 4;  // 4: triangles, 5: strip, 6: fan
  std::size_t positions = 0;
  std::optional<std::size_t> indices, colors, material;
  std::vector<std::pair<std::size_t, std::size_t>> coordinates;  // set TEXCOORD_n, accessor
};

// A mesh in the place of a node. A mesh that several nodes use has several instances.
struct GltfInstance {
  Eigen::Matrix4d placement = Eigen::Matrix4d::Identity();  // from the mesh to the scene
  bool is_moved = false;                                    // false: `placement` is the identity
  std::vector<GltfPrimitive> primitives;
};

struct GltfScene {
  std::vector<GltfInstance> instances;
  std::size_t primitives = 0;                 // of all instances
  std::optional<Eigen::Vector3d> geo_offset;  // from the extras of a node
  bool textured = false;                      // a primitive has a baseColorTexture
  bool colored = false;                       // a primitive has COLOR_0 or a baseColorFactor
};

// Walks through the nodes of the default scene: the scene that the file names, otherwise its first
// scene, otherwise the nodes that are no children. Error that names the file and the node for a
// node that is used twice, a transformation that is malformed, a skin, morph targets with weights,
// or more than 250,000 primitives of all nodes together.
GltfScene scene_of(const GltfFile& file);

struct GltfCounts {
  std::uint64_t vertices = 0, faces = 0;  // upper bounds
  std::uint64_t described_bytes = 0;      // of the largest accessor, if it is not stored as it is
};
GltfCounts count_items(const GltfFile& file, const GltfScene& scene);

// What the faces of a primitive look like.
struct GltfMaterial {
  Eigen::Vector3d factor = Eigen::Vector3d::Ones();  // linear red, green, blue
  std::optional<std::size_t> image;
  std::array<Wrap, 2> wrap{Wrap::repeat, Wrap::repeat};
  std::size_t coordinates = 0;  // set of texture coordinates
  // Texture coordinates (u, v), with v from the upper edge, become turn * (u, v) + offset.
  Eigen::Matrix2d turn = Eigen::Matrix2d::Identity();
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();
};
GltfMaterial material_of(const GltfFile& file, const GltfPrimitive& primitive);

// Corners of the triangles. Triangles of strips with two equal corners are left out. Error for an
// index of at least `vertices`.
std::vector<std::array<std::uint32_t, 3>> triangles_of(GltfFile& file,
                                                       const GltfPrimitive& primitive,
                                                       std::size_t vertices);

// The texture coordinates of the vertices, in the texture. Error if there are not `vertices`, or if
// one of them is not finite.
std::vector<Eigen::Vector2d> coordinates_of(GltfFile& file, const GltfPrimitive& primitive,
                                            const GltfMaterial& material, std::size_t vertices);

// The linear colours of the vertices.
GltfValues colors_of(GltfFile& file, std::size_t accessor, std::size_t vertices);

// The picture of an image of the file.
TextureSource picture_of(GltfFile& file, std::size_t image);

}  // namespace axial::io
