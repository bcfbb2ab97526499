// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace axial {

// A triangle mesh. Seen from outside, the corners of a face are in counter-clockwise order.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Rgb> colors;  // empty or one per vertex
  std::vector<std::array<std::uint32_t, 3>> faces;
};

}  // namespace axial
