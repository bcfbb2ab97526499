// SPDX-License-Identifier: GPL-3.0-or-later
// Part of fuse(): decides whether two maps are enough for a point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cloud/fusion_map.h"
#include "scene/camera_model.h"

namespace axial::cloud {

// Returns the index of the first neighbour that agrees with the point of the asking pixel `i`.
// Empty if no neighbour agrees, or if any neighbour sees through the point or shows another normal
// there. `answers[n][i]`: the answer of neighbour n to asking pixel i (fusion_map.h).
std::optional<std::size_t> undisputed_witness(std::span<const std::vector<Answer>> answers,
                                              std::size_t i);

// Tests whether a pixel of a map lies in a piece of surface. The reason: two views may agree by
// chance on a wrong depth, and the depths around a wrong depth usually differ from it.
class SurfacePieces {
 public:
  // `max_distance`: the largest distance of a surrounding point from the pixel's tangent plane at
  // which the point lies on the plane, divided by the depth of the pixel. `map` must outlive the
  // object.
  SurfacePieces(const FusionMap& map, float max_distance);

  // True if, of the eight pixels that are 2 px away from `pixel` in x, in y or in both, at least
  // four lie on the tangent plane of `pixel` and at most three do not. Pixels outside the map or
  // without a depth do not count. False if `pixel` has no normal. Precondition: `pixel` has a
  // depth.
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
