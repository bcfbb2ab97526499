// SPDX-License-Identifier: GPL-3.0-or-later
// Casts rays at a triangle mesh (Embree). Hits are refined in double precision.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>

#include "simulate/triangle_mesh.h"

namespace axial::simulate {

struct Hit {
  double distance = 0;  // along the ray, to the plane of the face; computed in double
  std::uint32_t face = 0;
  float u = 0, v = 0;      // barycentric weights of the face's second and third corner
  Eigen::Vector3d normal;  // unit normal of the face, by the order of its corners
};

// Immutable after construction. All queries may run concurrently. One thread builds Embree's tree.
// So if two faces are equally near, the same face is hit for any number of threads.
class RayScene {
 public:
  // Copies the mesh. Error for a mesh without faces or a face index out of range.
  explicit RayScene(const TriangleMesh& mesh);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  // Returns the first face on the ray at a distance above 0. `direction` is of unit length.
  std::optional<Hit> first_hit(const Eigen::Vector3d& origin,
                               const Eigen::Vector3d& direction) const;

  // True if a face lies on the ray at a distance within [near, far]. `direction` is of unit length.
  bool blocked(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double near,
               double far) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace axial::simulate
