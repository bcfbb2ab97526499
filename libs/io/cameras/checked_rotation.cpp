// SPDX-License-Identifier: GPL-3.0-or-later
#include "cameras/private/checked_rotation.h"

#include <Eigen/SVD>

#include "base/error.h"

namespace axial::io {

Eigen::Matrix3d checked_rotation(const Eigen::Matrix3d& r, const std::string& where) {
  if (!r.allFinite()) fail("{} contains a value that is not finite", where);
  const double deviation = (r * r.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(deviation <= 1e-3))
    fail("{} is not a rotation: R R^T differs from I by {}", where, deviation);
  if (r.determinant() < 0)
    fail("{} is not a rotation: its determinant is {}", where, r.determinant());
  // A matrix that is a rotation up to rounding stays unchanged, so that reading and writing a file
  // does not change it.
  if (deviation < 1e-9) return r;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(r, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

}  // namespace axial::io
