// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace axial {

// A triangle mesh in the frame and unit of the scene. Seen from outside, the corners of a face are
// in counter-clockwise order. check_mesh() tests the rules below.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;            // finite
  std::vector<Rgb> colors;                          // empty or one per vertex
  std::vector<std::array<std::uint32_t, 3>> faces;  // indices into `vertices`
  // Marks of the faces, empty or one per face: 1 if the place of the face was not seen by two
  // cameras, so that the face only closes a gap (mesh/unseen.h); otherwise 0.
  std::vector<std::uint8_t> unseen{};
};

}  // namespace axial
