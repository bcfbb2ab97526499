// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/decompositions.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

namespace axial {
namespace {

using Eigen::Matrix3Xd, Eigen::Matrix3d, Eigen::Vector3d;

class Random {
 public:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Vector3d vector() { return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }
  Matrix3d rotation() {
    return Eigen::AngleAxisd(uniform(0, 3), vector().normalized()).toRotationMatrix();
  }
  Matrix3Xd points(Eigen::Index count) {
    Matrix3Xd points(3, count);
    for (Eigen::Index i = 0; i < count; ++i) points.col(i) = vector();
    return points;
  }

 private:
  std::mt19937_64 engine_{7};
};

// The ends of three perpendicular axes. The extents of these points are proportional to the lengths
// of the axes.
Matrix3Xd axes(const Matrix3d& rotation, const Vector3d& lengths) {
  Matrix3Xd points(3, 6);
  points.leftCols<3>() = rotation * lengths.asDiagonal();
  points.rightCols<3>() = -points.leftCols<3>();
  return points;
}

TEST(RelativeWidth, IsTheMiddleAxisOverTheLongest) {
  Random random;
  for (int k = 0; k < 200; ++k) {
    const double width = std::pow(10, random.uniform(-5, 0));
    const double size = std::pow(10, random.uniform(-200, 200));
    Matrix3Xd points =
        axes(random.rotation(), size * Vector3d(width * random.uniform(0, 1), 1, width));
    points.colwise() += 10 * size * random.vector();
    // After the shift the coordinates have 15 digits, so that the square of the width has an error
    // of 1e-15. The error of the width is this error divided by twice the width. A factor of ten
    // allows for the sums.
    EXPECT_NEAR(relative_width(points), width, 1e-14 / width + 1e-12) << width << " " << size;
  }
}

TEST(RelativeWidth, IsZeroForALineOnePlaceAndTooFewPoints) {
  Random random;
  const Vector3d start = random.vector(), along = random.vector();
  Matrix3Xd line(3, 9);
  for (Eigen::Index i = 0; i < 9; ++i) line.col(i) = start + static_cast<double>(i * i) * along;
  // The square root of the rounding error of the square.
  EXPECT_LT(relative_width(line), 1e-7);
  EXPECT_EQ(relative_width(start.replicate(1, 4)), 0);
  EXPECT_EQ(relative_width(start), 0);
  EXPECT_EQ(relative_width(Matrix3Xd(3, 0)), 0);
}

TEST(SymmetricEigen, SolvesTheEquationInIncreasingOrder) {
  Random random;
  for (const Eigen::Index size : {1, 3, 6, 9}) {
    Eigen::MatrixXd matrix(size, size);
    for (double& entry : matrix.reshaped()) entry = random.uniform(-1, 1);
    matrix += matrix.transpose().eval();
    Eigen::MatrixXd lower = matrix;
    lower.triangularView<Eigen::StrictlyUpper>().setConstant(99);  // must not be read
    const EigenPairs pairs = symmetric_eigen(lower);
    for (Eigen::Index i = 0; i < size; ++i) {
      // About ten roundings of 1e-16 in each row.
      const Eigen::VectorXd vector = pairs.vectors.col(i);
      EXPECT_LT((matrix * vector - pairs.values(i) * vector).norm(), 1e-13);
      EXPECT_NEAR(vector.norm(), 1, 1e-14);
      EXPECT_GE(pairs.values(i), pairs.values(std::max<Eigen::Index>(i - 1, 0)));
    }
  }
}

TEST(BestSimilarity, IsTheOneThatMovedThePoints) {
  Random random;
  for (int k = 0; k < 100; ++k) {
    const Matrix3Xd from = random.points(5);
    const Matrix3d rotation = random.rotation();
    const double scale = random.uniform(0.1, 10);
    const Vector3d translation = random.vector();
    const Matrix3Xd to = (scale * (rotation * from)).colwise() + translation;
    const Similarity fit = best_similarity(from, to);
    // Roundings of 1e-15 of coordinates up to 20, for sets of points up to a hundred times as long
    // as wide.
    EXPECT_NEAR(fit.scale, scale, 1e-12 * scale);
    EXPECT_LT((fit.rotation - rotation).norm(), 1e-12);
    EXPECT_LT((fit.translation - translation).norm(), 1e-11);
  }
}

TEST(BestSimilarity, WithoutScaleIsTheRotationAndTheShiftOfMeans) {
  Random random;
  const Matrix3Xd from = random.points(6);
  const Matrix3d rotation = random.rotation();
  const Similarity fit = best_similarity(from, 3 * (rotation * from), false);
  EXPECT_NEAR(fit.scale, 1, 1e-14);
  EXPECT_LT((fit.rotation - rotation).norm(), 1e-12);
  const Vector3d mean = rotation * from.rowwise().mean();
  EXPECT_LT((fit.translation - 2 * mean).norm(), 1e-12);
}

TEST(BestSimilarity, NeverReflects) {
  Random random;
  const Matrix3Xd from = random.points(6);
  const Similarity fit = best_similarity(from, Vector3d(1, 1, -1).asDiagonal() * from);
  // About ten roundings of 1e-16.
  EXPECT_NEAR(fit.rotation.determinant(), 1, 1e-14);
}

}  // namespace
}  // namespace axial
