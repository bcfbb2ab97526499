// SPDX-License-Identifier: GPL-3.0-or-later
// A cone around all rays of a photograph.
#pragma once

#include <Eigen/Core>

#include "labels/posed_rays.h"

namespace axial::labels {

class ViewCone {
 public:
  explicit ViewCone(const PosedRays& rays);

  const Eigen::Vector3d& apex() const { return apex_; }

  // False if no ray of the photograph meets the ball [frame of the mesh].
  bool may_meet(const Eigen::Vector3d& centre, double radius) const;

 private:
  Eigen::Vector3d apex_, axis_;
  double angle_ = 0;   // between the axis and the outermost rays, with a margin
  double beside_ = 0;  // the largest distance of the begin of a ray from the apex
};

}  // namespace axial::labels
