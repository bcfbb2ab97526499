// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle mesh for queries of distance and occlusion.
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

// Error if a face index is out of range or a coordinate is not finite.
void require_valid(const Mesh& mesh);

// Holds a copy of the triangles in an Embree hierarchy. All queries may run concurrently. The
// answers do not depend on the number of threads.
class Surface {
 public:
  // Error if the mesh has no faces, a face index is out of range or a coordinate is not finite.
  explicit Surface(const Mesh& mesh);
  ~Surface();
  Surface(Surface&&) noexcept;
  Surface& operator=(Surface&&) noexcept;

  // Returns the nearest point of the surface. The result is exact up to rounding: distances to
  // triangles are computed in double, and Embree's hierarchy only excludes triangles that are too
  // far away.
  ClosestPoint closest(const Eigen::Vector3d& point) const;

  // The unit normal of a face; zero for a face without area.
  Eigen::Vector3d face_normal(std::uint32_t face) const;

  // True if a triangle crosses the open segment from `from` to `to`. The first part of the segment
  // does not count, so that a point on the surface does not hide itself. `skip`: the length of this
  // part divided by the length of the segment.
  bool blocked(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double skip = 1e-4) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Returns the unsigned distance [m] of every point to the surface, in the points' order.
std::vector<float> distances_to(const Surface& surface, std::span<const Eigen::Vector3f> points);

}  // namespace axial::evaluate
