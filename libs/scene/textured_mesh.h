// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "scene/mesh.h"

namespace axial {

// A triangle mesh with one or more texture images. Corner k of face f has the colour that the
// texture texture_of[f] has at the pixel uv[f][k]. Inside a face, uv is linear. Pixels are (x, y)
// with x to the right, y down, and pixel centres at integers: the upper left corner of a texture is
// (-0.5, -0.5). Files of textured meshes have other conventions. io/textured converts the
// coordinates.
struct TexturedMesh {
  using Corners = std::array<Eigen::Vector2f, 3>;

  Mesh mesh;
  std::vector<Corners> uv;                // one per face [px]
  std::vector<std::uint32_t> texture_of;  // one per face: index into `textures`
  std::vector<cv::Mat3b> textures;        // B G R
};

}  // namespace axial
