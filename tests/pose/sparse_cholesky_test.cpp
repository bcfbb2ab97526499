// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/adjust/sparse_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <vector>

namespace axial::pose {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

// The normal matrix of a grid of unknowns of which neighbours have common observations.
Sparse grid_matrix(int width, double diagonal) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> weight(0.1, 1);
  Sparse matrix(width * width, width * width);
  std::vector<Eigen::Triplet<double>> entries;
  const auto link = [&](int a, int b) {
    const double w = weight(random);
    entries.insert(entries.end(), {{a, a, w}, {b, b, w}, {a, b, -w}, {b, a, -w}});
  };
  for (int y = 0; y < width; ++y)
    for (int x = 0; x < width; ++x) {
      entries.emplace_back(y * width + x, y * width + x, diagonal);
      if (x > 0) link(y * width + x, y * width + x - 1);
      if (y > 0) link(y * width + x, (y - 1) * width + x);
    }
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

TEST(SparseCholesky, GivesTheFormOfTheDenseInverse) {
  for (const int width : {1, 2, 20}) {
    const Sparse matrix = grid_matrix(width, 0.01);
    const Eigen::MatrixXd inverse = Eigen::MatrixXd(matrix).inverse();
    double operations = -1;
    const SparseCholesky factor(matrix, [&](double count) { operations = count; });
    EXPECT_GT(operations, 0);
    ASSERT_TRUE(factor.is_positive_definite());
    for (const Eigen::Index row : {Eigen::Index{0}, matrix.rows() / 2}) {
      Eigen::VectorXd v = Eigen::VectorXd::LinSpaced(matrix.rows(), -1, 2);
      v(row) += 1;
      EXPECT_NEAR(factor.inverse_form(v), v.dot(inverse * v), 1e-10 * v.dot(inverse * v));
      EXPECT_LT((factor.solve(v) - inverse * v).norm(), 1e-10 * (inverse * v).norm());
    }
  }
}

TEST(SparseCholesky, ReadsTheLowerTriangleAlone) {
  const Sparse matrix = grid_matrix(5, 1);
  const Sparse lower = matrix.triangularView<Eigen::Lower>();
  const Eigen::VectorXd v = Eigen::VectorXd::LinSpaced(25, 1, 2);
  EXPECT_EQ(SparseCholesky(lower).inverse_form(v), SparseCholesky(matrix).inverse_form(v));
}

TEST(SparseCholesky, FindsThatAMatrixIsNotPositiveDefinite) {
  EXPECT_FALSE(SparseCholesky(grid_matrix(20, -0.1)).is_positive_definite());
  EXPECT_TRUE(SparseCholesky(grid_matrix(20, 0.1)).is_positive_definite());
}

}  // namespace
}  // namespace axial::pose
