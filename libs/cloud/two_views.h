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

// Returns the index of the first neighbour that agrees with the point of pixel `i`. Empty in two
// cases: no neighbour agrees, or some neighbour sees through the point or shows another normal
// there. `answers[n][i]`: the answer of neighbour n to pixel `i`.
std::optional<std::size_t> undisputed_witness(std::span<const std::vector<Answer>> answers,
                                              std::size_t i);

// Tests whether a pixel of a map lies in a piece of surface. Two views may agree by chance on a
// wrong depth. Around such a pixel the depths usually differ. The map must outlive the object.
class SurfacePieces {
 public:
  // `max_distance`: the largest distance of the surrounding points from the pixel's tangent plane,
  // relative to the pixel's depth.
  SurfacePieces(const FusionMap& map, float max_distance);

  // True if, of the eight pixels at a distance of two from `pixel`, at least four lie on the
  // tangent plane of `pixel` and at most three do not. Pixels without a depth do not count. False
  // if `pixel` has no normal. Only five pixels surround a pixel at the border of the image, and
  // only three a pixel in a corner. Precondition: `pixel` has a depth.
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
