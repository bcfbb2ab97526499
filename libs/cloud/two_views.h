// SPDX-License-Identifier: GPL-3.0-or-later
// Inside of fuse(): where two maps are enough for a point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cloud/fusion_map.h"

namespace axial::cloud {

// The first neighbour that shows the point of asking pixel `i`, if no neighbour sees through the
// point or shows another normal there.
// `answers[n][i]`: what neighbour n says to the pixel.
std::optional<std::size_t> undisputed_witness(std::span<const std::vector<Answer>> answers,
                                              std::size_t i);

// Tells where a map, which it refers to, shows a piece of surface. Wrong depths that two views
// agree on by chance mostly have other depths around them.
class SurfacePieces {
 public:
  // `max_distance`: how far from a pixel's tangent plane the points around it may lie, relative to
  // the pixel's depth.
  SurfacePieces(const FusionMap& map, float max_distance);

  // Of the eight pixels two away from `pixel`, which has a depth, four or more lie on its tangent
  // plane, and at most three with a depth lie off it. False for a pixel without a normal. (At an
  // image's border a pixel has five around it, in a corner three.)
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
