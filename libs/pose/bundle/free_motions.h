// SPDX-License-Identifier: GPL-3.0-or-later
// Motions of a whole model that known coordinates do not determine.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "pose/bundle/adjust_options.h"

namespace axial::pose {

// A small rigid motion of the whole model: the point X moves by shift_of(X).
struct Motion {
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  // rotation vector [rad, world frame]
  Eigen::Vector3d about = Eigen::Vector3d::Zero();     // a point of the axis [m]
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();     // of `about` [m]

  Eigen::Vector3d shift_of(const Eigen::Vector3d& X) const {
    return rotation.cross(X - about) + shift;
  }
};

// Independent motions that change none of the coordinates that `options.places` and
// `options.positions` state, at the present places of the bundle: none if these coordinates
// determine position and orientation of the model, and six if nothing is known. A motion also
// counts as free if it changes the coordinates by less than a thousandth of the motion that changes
// them most, as turning about a line on which all known points lie.
std::vector<Motion> free_motions(const Bundle& bundle, const AdjustOptions& options);

}  // namespace axial::pose
