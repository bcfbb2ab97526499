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

#include "io/images/image.h"
#include "io/textured/textured_mesh.h"
#include "private/only_for_io.h"
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

// texture_files_of() an OBJ.
TextureFiles texture_files_of_obj(const std::filesystem::path& path);

// The headers of the images that are the colours of a GLB's materials. Errors as for
// read_textured_glb().
std::vector<ImageHeader> color_headers_of_glb(const std::filesystem::path& path);

// read_shape() for OBJ and GLB.
Mesh read_shape_obj(const std::filesystem::path& path, const std::optional<LocalFrame>& frame);
Mesh read_shape_glb(const std::filesystem::path& path, const std::optional<LocalFrame>& frame);

}  // namespace axial::io
