// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/adjust/shape_sigma.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace axial::pose {
namespace {

// The derivatives of the places with respect to a similarity about their mean: three columns for
// the movement, three for the rotation, one for the scale.
Eigen::MatrixXd derivatives_of_similarity(const Eigen::Matrix3Xd& places) {
  const Eigen::Matrix3Xd about_mean = places.colwise() - places.rowwise().mean().eval();
  const double size = about_mean.norm();
  Eigen::MatrixXd result(3 * places.cols(), 7);
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    const Eigen::Vector3d place = about_mean.col(i) / size;
    auto rows = result.middleRows(3 * i, 3);
    rows.leftCols(3).setIdentity();
    for (int k = 0; k < 3; ++k) rows.col(3 + k) = Eigen::Vector3d::Unit(k).cross(place);
    rows.col(6) = place;
  }
  return result;
}

}  // namespace

Eigen::VectorXd sigmas_after_similarity(const Eigen::Matrix3Xd& places,
                                        const Eigen::MatrixXd& covariance) {
  if (places.cols() < 3) return Eigen::VectorXd::Zero(places.cols());
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(derivatives_of_similarity(places));
  // Places on a line have only six directions: a rotation about the line moves no place.
  qr.setThreshold(1e-9);
  const Eigen::MatrixXd basis =
      qr.householderQ() * Eigen::MatrixXd::Identity(covariance.rows(), qr.rank());
  const auto complement = [&](const Eigen::MatrixXd& columns) {
    return Eigen::MatrixXd(columns - basis * (basis.transpose() * columns));
  };
  const Eigen::MatrixXd rest = complement(complement(covariance).transpose());
  Eigen::VectorXd sigmas(places.cols());
  for (Eigen::Index i = 0; i < places.cols(); ++i)
    sigmas(i) = std::sqrt(std::max(0.0, rest.diagonal().segment<3>(3 * i).sum()));
  return sigmas;
}

}  // namespace axial::pose
