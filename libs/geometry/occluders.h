// SPDX-License-Identifier: GPL-3.0-or-later
// Finds out whether a mesh hides points from a camera (Embree).
#pragma once

#include <Eigen/Core>
#include <memory>

#include "scene/mesh.h"

namespace axial::geometry {

// The faces of a mesh, prepared for tests whether they hide a point.
class Occluders {
 public:
  // `mesh` must outlive the object. Throws an Error for a mesh that check_mesh() refuses
  // (scene/check_mesh.h), for example without faces or with a coordinate that is not finite, for a
  // coordinate larger than 1e18, and for a failure of Embree.
  explicit Occluders(const Mesh& mesh);
  ~Occluders();
  Occluders(const Occluders&) = delete;
  Occluders& operator=(const Occluders&) = delete;

  // True if a face crosses the segment from `from` to `to`, in the frame of the mesh. Crossings
  // near `to` do not count: the segment ends before `to` by `tolerance` (0 to 1) times its length.
  // A face therefore does not hide a point `to` that lies on the face. True also if a
  // coordinate of `from` or of `to` - `from` is larger than 1e18 or not finite. May be called
  // concurrently.
  bool between(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double tolerance) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace axial::geometry
