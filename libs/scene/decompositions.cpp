// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/decompositions.h"

#include <Eigen/Geometry>
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
  // Squared extents have half of a double's digits, which is far finer than kLineWidth.
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const auto& point : centred.colwise()) moments += point * point.transpose();
  const SymmetricEigen3 squares(moments, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d& extents = squares.eigenvalues();
  return std::sqrt(std::max(extents(1), 0.0) / extents(2));
}

Eigen::Matrix4d best_similarity(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to,
                                bool with_scale) {
  return Eigen::umeyama(from, to, with_scale);
}

}  // namespace axial
