// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle mesh for queries of distance and occlusion, and for rays (Embree).
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

// The faces of a mesh in an Embree hierarchy. All queries may run concurrently. The answers do not
// depend on the number of threads. Coordinates of queries are in the frame of the mesh.
class Surface {
 public:
  // `mesh` must outlive the object, or is moved into it. Throws an Error for a mesh that
  // check_mesh() refuses (scene/check_mesh.h), for example without faces or with a coordinate that
  // is not finite, for a coordinate larger than 1e18, and for a failure of Embree.
  explicit Surface(const Mesh& mesh);
  explicit Surface(Mesh&& mesh);
  ~Surface();
  Surface(Surface&&) noexcept;
  Surface& operator=(Surface&&) noexcept;

  // Returns the nearest point of the surface. The result is exact up to rounding: distances to
  // triangles are computed in double, and Embree's hierarchy only excludes triangles that are too
  // far away. Precondition: `point` is finite.
  ClosestPoint closest(const Eigen::Vector3d& point) const;

  // The unit normal of the face with this index, on the side from which its corners are
  // counterclockwise. Zero for a face without area. Precondition: the face exists.
  Eigen::Vector3d face_normal(std::uint32_t face) const;

  // True if a face crosses the segment from `from` to `to`, in either direction. A part at each end
  // does not count, so that a face does not hide a point that lies on it: the part that is
  // `at_from` (0 to 1) of the length of the segment, and the part that is `at_to` (0 to 1) of it.
  // True also if a coordinate of `from` or of `to` - `from` is larger than 1e18 or not finite:
  // nothing is seen from so far away.
  bool between(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double at_from,
               double at_to) const;

  // Returns the first place where the ray from `origin` along `direction` meets the surface, from
  // either side; nothing if it does not meet the surface, or if a coordinate of `origin` or of
  // `direction` is larger than 1e18 or not finite.
  std::optional<SurfaceHit> first_hit(const Eigen::Vector3d& origin,
                                      const Eigen::Vector3d& direction) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// The memory [bytes] of a Surface of `mesh` while it is made.
std::uint64_t bytes_of_surface(const Mesh& mesh);

// Returns the unsigned distance [m] of every point to the surface, in the order of `points`.
std::vector<float> distances_to(const Surface& surface, std::span<const Eigen::Vector3f> points);

}  // namespace axial::geometry
