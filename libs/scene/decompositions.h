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

// Of a symmetric matrix of any size. Only its lower triangle is read.
EigenPairs symmetric_eigen(const Eigen::MatrixXd& matrix);

// The second largest extent of points (columns) about their mean, over the largest: 0 for points on
// a line, for fewer than two points and for points that all are in one place.
double relative_width(const Eigen::Matrix3Xd& points);

// Points whose relative width is below this lie on one line: nothing keeps what is fitted to them
// from turning about it.
inline constexpr double kLineWidth = 1e-3;

// The similarity, as a 4 x 4 matrix, that brings `from` onto `to` with the least sum of squared
// distances (S. Umeyama, 1991). Points are columns, as many in both. Without `with_scale` its scale
// is 1.
Eigen::Matrix4d best_similarity(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to,
                                bool with_scale = true);

}  // namespace axial
