// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: parts of the readers of textured meshes.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "axial/base.h"
#include "bytes/private/only_for_io.h"
#include "io/images/image.h"
#include "io/textured/textured_mesh.h"
#include "scene/local_frame.h"
#include "scene/mesh.h"

namespace axial::io {

// Converts the texture coordinates (u, v) of PLY and OBJ files to pixels of a texture of the given
// size: x = u width - 0.5, y = (1 - v) height - 0.5. The result is not finite if it is too large
// for float.
inline Eigen::Vector2f pixel_of(const Eigen::Vector2d& uv, const cv::Size& texture) {
  return {static_cast<float>(uv.x() * texture.width - 0.5),
          static_cast<float>((1 - uv.y()) * texture.height - 0.5)};
}

// Converts stored positions to `frame`. `offset` is the origin of the stored positions, if the file
// states it, otherwise the world's origin. Without `frame`, positions stay as they are stored.
// Error that begins with `file` if a position does not fit into float.
std::vector<Eigen::Vector3f> placed_in(const std::optional<LocalFrame>& frame,
                                       std::span<const Eigen::Vector3d> stored,
                                       const std::optional<Eigen::Vector3d>& offset,
                                       const std::string& file);

// Which parts of a mesh a reader reads. `sizes`: as textured, without decoding pictures.
enum class MeshParts { shape, textured, sizes };

// The functions of textured_mesh.h for the meshes of one format. Errors as there.
struct MeshFormat {
  using Path = const std::filesystem::path&;
  using Frame = const std::optional<LocalFrame>&;

  TexturedMesh (*read_textured)(Path path, Frame frame, const Context& context);
  Mesh (*read_shape)(Path path, Frame frame);
  bool (*is_textured)(Path path);
  TextureFiles (*texture_files)(Path path);
  MeshPlace (*place)(Path path);
  std::uint64_t (*bytes_of_textures)(Path path, const Context& context);
  std::uint64_t (*bytes_to_read)(Path path);
};
extern const MeshFormat kPlyMeshes, kObjMeshes, kGltfMeshes;

}  // namespace axial::io
