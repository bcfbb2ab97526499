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

namespace axial::geometry {

// The point of a surface that is nearest to a query.
struct ClosestPoint {
  Eigen::Vector3d point;  // in the frame of the mesh
  double distance;        // from the query to `point`
  std::uint32_t face;     // index of the face on which `point` lies; of several: the lowest
};

// The place where a ray meets the surface.
struct SurfaceHit {
  std::uint32_t face;  // index of the face
  float u, v;          // barycentric weights of the face's second and third corner
};

// Error if a face refers to a vertex that does not exist, or if a coordinate is not finite.
void require_valid(const Mesh& mesh);

// Holds a copy of the triangles in an Embree hierarchy. All queries may run concurrently. The
// answers do not depend on the number of threads. Coordinates of queries are in the frame of the
// mesh, and must be finite.
class Surface {
 public:
  // Error if the mesh has no faces, if a coordinate is larger than 1e18, or as for require_valid().
  explicit Surface(const Mesh& mesh);
  ~Surface();
  Surface(Surface&&) noexcept;
  Surface& operator=(Surface&&) noexcept;

  // Returns the nearest point of the surface. The result is exact up to rounding: distances to
  // triangles are computed in double, and Embree's hierarchy only excludes triangles that are too
  // far away.
  ClosestPoint closest(const Eigen::Vector3d& point) const;

  // The unit normal of the face with this index, on the side from which its corners are
  // counterclockwise. Zero for a face without area. Precondition: the face exists.
  Eigen::Vector3d face_normal(std::uint32_t face) const;

  // True if a triangle crosses the segment from `from` to `to`, in either direction. The part of
  // the segment next to `from` does not count, so that a point on the surface does not hide itself.
  // `skip`: the length of this part divided by the length of the segment. True also if a
  // coordinate of `from` or of `to` - `from` is larger than 1e18 or not finite: nothing is seen
  // from so far away.
  bool blocked(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double skip = 1e-4) const;

  // Returns the first place where the ray from `origin` along `direction` meets the surface, from
  // either side; nothing if it does not meet the surface, or if a coordinate of `origin` or of
  // `direction` is larger than 1e18 or not finite.
  std::optional<SurfaceHit> first_hit(const Eigen::Vector3d& origin,
                                      const Eigen::Vector3d& direction) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Returns the unsigned distance [m] of every point to the surface, in the order of `points`.
std::vector<float> distances_to(const Surface& surface, std::span<const Eigen::Vector3f> points);

}  // namespace axial::geometry
