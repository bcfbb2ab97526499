// SPDX-License-Identifier: GPL-3.0-or-later
// Matrix decompositions that several libraries need. Only decompositions.cpp compiles them, because
// each takes seconds to compile.
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "axial/scene.h"

extern template class Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;

namespace axial {

using SymmetricEigen3 = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;

// Eigenvalues in increasing order. Column k of `vectors` is the eigenvector of values(k), of unit
// length.
struct EigenPairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

// The eigenvalues and eigenvectors of a symmetric matrix of any size. Only the lower triangle is
// read. A matrix with NaN gives NaN.
EigenPairs symmetric_eigen(const Eigen::MatrixXd& matrix);

// Let the principal extents of `points` be the square roots of the eigenvalues of their second
// moments about their mean. Returns the ratio of the second largest to the largest extent.
// `points`: one point per column, all finite. The result is 0 for points on a line, for fewer
// than two points and for points that coincide.
double relative_width(const Eigen::Matrix3Xd& points);

// Points with a smaller relative_width() are treated as a line. A fit to such points does not
// determine the rotation about the line.
inline constexpr double kLineWidth = 1e-3;

// The map x -> scale * rotation * x + translation. `rotation` has determinant 1.
struct Similarity {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  // The point to which the point x is mapped.
  Eigen::Vector3d operator()(const Eigen::Vector3d& x) const {
    return scale * (rotation * x) + translation;
  }
  // The pose of a camera that is moved together with the points. The directions of the points in
  // the camera frame do not change.
  Pose operator()(const Pose& pose) const {
    return {pose.rotation * rotation.transpose(), (*this)(pose.centre)};
  }
  // Returns the map that applies `first`, then this map.
  Similarity after(const Similarity& first) const;
  // The homogeneous 4 x 4 matrix M of this map: M (x, 1) = (mapped x, 1).
  Eigen::Matrix4d matrix() const;
};

// The similarity that maps `from` to `to` with the smallest sum of squared distances (S. Umeyama,
// 1991). Points are columns; column k of `from` corresponds to column k of `to`. Precondition:
// `from` and `to` have the same number of points, at least one. With `with_scale`, the points of
// `from` must not all coincide. Points on a line do not determine the rotation about the line: the
// result is then one of the best similarities (see relative_width()). Without `with_scale` the
// scale is 1.
Similarity best_similarity(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to,
                           bool with_scale = true);

}  // namespace axial
