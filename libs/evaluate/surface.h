// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle mesh that answers how far a point is and whether something stands in between.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scene/mesh.h"

namespace axial::evaluate {

struct ClosestPoint {
  Eigen::Vector3d point;
  double distance;
  std::uint32_t face;
};

// Keeps an own copy of the triangles in an Embree hierarchy. All queries may run on many threads
// and give the same answer whatever the number.
class Surface {
 public:
  // Error if the mesh has no faces, a face index is out of range or a coordinate is not finite.
  explicit Surface(const Mesh& mesh);
  ~Surface();
  Surface(Surface&&) noexcept;
  Surface& operator=(Surface&&) noexcept;

  // The nearest point of the surface. The triangles are those of the mesh (float); the distance to
  // them is computed in double and the hierarchy only prunes, so it is exact to rounding.
  ClosestPoint closest(const Eigen::Vector3d& point) const;

  // Unit normal of a face; zero for one without area.
  Eigen::Vector3d face_normal(std::uint32_t face) const;

  // True if a triangle crosses the open segment from `from` to `to`. The first `skip` [fraction of
  // its length] is left out, so that a point on the surface does not hide itself.
  bool blocked(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double skip = 1e-4) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Unsigned distance [m] of every point to the surface, in the points' order.
std::vector<float> distances_to(const Surface& surface, std::span<const Eigen::Vector3f> points);

}  // namespace axial::evaluate
