// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/decompositions.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

template class Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;

namespace axial {

EigenPairs symmetric_eigen(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(matrix);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

double relative_width(const Eigen::Matrix3Xd& points) {
  if (points.cols() < 2) return 0;
  Eigen::Matrix3Xd centred = points.colwise() - points.rowwise().mean();
  const double largest = centred.cwiseAbs().maxCoeff();
  if (!(largest > 0)) return 0;
  centred /= largest;
  // Squaring halves the number of significant digits. The relative error of 1e-8 that is left is
  // far below kLineWidth.
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const auto& point : centred.colwise()) moments += point * point.transpose();
  const SymmetricEigen3 squares(moments, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d& extents = squares.eigenvalues();
  return std::sqrt(std::max(extents(1), 0.0) / extents(2));
}

Similarity Similarity::after(const Similarity& first) const {
  return {scale * first.scale, rotation * first.rotation, (*this)(first.translation)};
}

Eigen::Matrix4d Similarity::matrix() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = scale * rotation;
  m.topRightCorner<3, 1>() = translation;
  return m;
}

Similarity best_similarity(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to,
                           bool with_scale) {
  const Eigen::Matrix4d matrix = Eigen::umeyama(from, to, with_scale);
  Similarity fit;
  fit.scale = std::cbrt(matrix.topLeftCorner<3, 3>().determinant());
  fit.rotation = matrix.topLeftCorner<3, 3>() / fit.scale;
  fit.translation = matrix.topRightCorner<3, 1>();
  return fit;
}

}  // namespace axial
