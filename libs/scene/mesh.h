// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace axial {

// A triangle mesh; outward normals see the corners counter-clockwise.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Rgb> colors;  // empty or one a vertex
  std::vector<std::array<std::uint32_t, 3>> faces;
};

}  // namespace axial
