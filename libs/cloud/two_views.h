// SPDX-License-Identifier: GPL-3.0-or-later
// Part of fuse(): decides whether two maps are enough for a point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cloud/fusion_map.h"

namespace axial::cloud {

// The index of the first neighbour that agrees with the point of pixel `i`. Empty if no neighbour
// agrees, or if a neighbour sees through the point or shows another normal there. `answers[n][i]`:
// the answer of neighbour n to pixel `i`.
std::optional<std::size_t> undisputed_witness(std::span<const std::vector<Answer>> answers,
                                              std::size_t i);

// Tests whether a pixel of a map lies in a piece of surface. Two views may agree by chance on a
// wrong depth; around such a pixel the depths usually differ. The map must exist as long as the
// object.
class SurfacePieces {
 public:
  // `max_distance`: the largest distance of the surrounding points from the pixel's tangent plane,
  // relative to the pixel's depth.
  SurfacePieces(const FusionMap& map, float max_distance);

  // True if, of the eight pixels at a distance of two from `pixel`, at least four lie on its
  // tangent plane and at most three do not; pixels without a depth do not count. False if `pixel`
  // has no normal. At the border of the image only five pixels surround it, in a corner only three.
  // Precondition: `pixel` has a depth.
  bool around(std::uint32_t pixel) const;

 private:
  template <class Camera>
  bool enough_on_plane(const Camera& camera, int x, int y, const Eigen::Vector3f& normal) const;

  const FusionMap& map_;
  CameraVariant<float> camera_;
  Eigen::Matrix3f to_camera_;
  float max_distance_;
};

}  // namespace axial::cloud
