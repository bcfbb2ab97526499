// SPDX-License-Identifier: GPL-3.0-or-later
// Ray casting against a triangle mesh (Embree), with hits refined in double precision.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>

#include "simulate/triangle_mesh.h"

namespace axial::simulate {

struct Hit {
  double distance = 0;  // along the unit direction, from the plane of the face in double
  std::uint32_t face = 0;
  float u = 0, v = 0;      // barycentric weights of the face's second and third corner
  Eigen::Vector3d normal;  // unit, of the face, by the order of its corners
};

// Immutable once built; all queries may run concurrently. The tree is built by one thread, so that
// ties between faces fall the same way whatever the number of threads.
class RayScene {
 public:
  // Keeps a copy of what it needs. Error for an empty mesh or a face index out of range.
  explicit RayScene(const TriangleMesh& mesh);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  // The first face hit at a distance above 0.
  std::optional<Hit> first_hit(const Eigen::Vector3d& origin,
                               const Eigen::Vector3d& direction) const;

  // True if a face lies on the ray at a distance within [near, far].
  bool blocked(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double near,
               double far) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace axial::simulate
