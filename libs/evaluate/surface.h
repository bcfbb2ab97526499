// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle mesh for queries of distance and occlusion, and for rays.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "scene/mesh.h"

namespace axial::evaluate {

struct ClosestPoint {
  Eigen::Vector3d point;
  double distance;
  std::uint32_t face;
};

// The place where a ray meets the surface.
struct SurfaceHit {
  std::uint32_t face;
  float u, v;  // barycentric weights of the face's second and third corner
};

// Error if a face index is out of range or a coordinate is not finite.
void require_valid(const Mesh& mesh);

// Holds a copy of the triangles in an Embree hierarchy. All queries may run concurrently. The
// answers do not depend on the number of threads: one thread builds the hierarchy.
class Surface {
 public:
  // Error if the mesh has no faces, a face index is out of range or a coordinate is not finite.
  explicit Surface(const Mesh& mesh);
  ~Surface();
  Surface(Surface&&) noexcept;
  Surface& operator=(Surface&&) noexcept;

  // Returns the nearest point of the surface. The distance to the triangles, which are float, is
  // computed in double. The hierarchy only prunes, so the result is exact up to rounding.
  ClosestPoint closest(const Eigen::Vector3d& point) const;

  // The unit normal of a face; zero for a face without area.
  Eigen::Vector3d face_normal(std::uint32_t face) const;

  // True if a triangle crosses the open segment from `from` to `to`. The first part of the segment
  // (`skip`, a fraction of its length) is left out, so that a point on the surface does not hide
  // itself.
  bool blocked(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double skip = 1e-4) const;

  // Returns the first place where the ray from `origin` along `direction` meets the surface, from
  // either side; nothing if it does not meet the surface.
  std::optional<SurfaceHit> first_hit(const Eigen::Vector3d& origin,
                                      const Eigen::Vector3d& direction) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Returns the unsigned distance [m] of every point to the surface, in the points' order.
std::vector<float> distances_to(const Surface& surface, std::span<const Eigen::Vector3f> points);

}  // namespace axial::evaluate
