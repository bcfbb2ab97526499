// SPDX-License-Identifier: GPL-3.0-or-later
// Matrix decompositions that several libraries need. Each of them takes seconds to compile: they
// are compiled here, once, and nowhere else.
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

extern template class Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;

namespace axial {

using SymmetricEigen3 = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;

// Eigenvalues in increasing order, and the eigenvectors of unit length in the columns.
struct EigenPairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

// The eigenvalues of a symmetric matrix of any size. Only its lower triangle is read. NaN in gives
// NaN out.
EigenPairs symmetric_eigen(const Eigen::MatrixXd& matrix);

// The second largest extent of points (columns, finite) about their mean, divided by the largest
// extent. 0 for points on a line, for fewer than two points and for points that coincide.
double relative_width(const Eigen::Matrix3Xd& points);

// Points of a smaller relative width count as a line: a fit to them may turn about that line.
inline constexpr double kLineWidth = 1e-3;

// x -> scale * rotation * x + translation. `rotation` is no reflection.
struct SimilarityFit {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
};

// The similarity that brings `from` onto `to` with the least sum of squared distances (S. Umeyama,
// 1991). Both hold the same number of points, at least one, as columns. Points on a line leave the
// rotation about that line open (see relative_width). Without `with_scale` the scale is 1.
SimilarityFit best_similarity(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to,
                              bool with_scale = true);

}  // namespace axial
