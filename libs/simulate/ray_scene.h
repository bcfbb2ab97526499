// SPDX-License-Identifier: GPL-3.0-or-later
// Casts rays at a triangle mesh (Embree). Hits are refined in double precision.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "simulate/triangle_mesh.h"

namespace axial::simulate {

// The point at which a ray meets a face.
struct Hit {
  // Along the ray to the plane of the face [m], computed in double. If the ray is within 0.001 rad
  // of the plane: Embree's distance, computed in float.
  double distance = 0;
  std::uint32_t face = 0;  // index into TriangleMesh::faces
  float u = 0, v = 0;      // barycentric weights of the face's second and third corner
  Eigen::Vector3d normal;  // unit normal of the face, by the order of its corners
};

// A mesh at which rays can be cast, in the mesh's frame [m]. Immutable after construction. All
// queries may run concurrently. One thread builds Embree's tree. So if two faces are equally near,
// the same face is hit for any number of threads.
class RayScene {
 public:
  // Copies the mesh. Throws an Error for a mesh without faces, for a vertex index out of range, and
  // for a failure of Embree.
  explicit RayScene(const TriangleMesh& mesh);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  // Returns the first face on the ray at a distance above 0, seen from either side. Empty if the
  // ray meets no face. `direction` is of unit length.
  std::optional<Hit> first_hit(const Eigen::Vector3d& origin,
                               const Eigen::Vector3d& direction) const;

  // True if a face lies on the ray at a distance within [near, far]. `direction` is of unit length.
  bool blocked(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double near,
               double far) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// The unit normal at `hit` of the smooth surface: between the normals of the face's corners.
// `normals`: vertex_normals() of `mesh`, which the scene of the hit was built from.
Eigen::Vector3d smooth_normal(const TriangleMesh& mesh, std::span<const Eigen::Vector3f> normals,
                              const Hit& hit);

}  // namespace axial::simulate
