// SPDX-License-Identifier: GPL-3.0-or-later
// Finds out whether a mesh hides points from a camera (Embree).
#pragma once

#include <Eigen/Core>
#include <memory>

#include "scene/mesh.h"

namespace axial::texture {

class Occluders {
 public:
  // `mesh` must outlive the object. Error for a mesh without faces, a face index out of range, and
  // coordinates that are not finite.
  explicit Occluders(const Mesh& mesh);
  ~Occluders();
  Occluders(const Occluders&) = delete;
  Occluders& operator=(const Occluders&) = delete;

  // True if a face crosses the segment between `from` and `to`. The last part of the segment, a
  // share `tolerance` of its length, does not count, so that a point on the surface does not hide
  // itself. May be called concurrently.
  bool between(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double tolerance) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace axial::texture
