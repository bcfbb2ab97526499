// SPDX-License-Identifier: GPL-3.0-or-later
// Cholesky factorization of large sparse matrices.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>
#include <memory>

namespace axial::pose {

// The Cholesky factorization P A P^T = L L^T of a symmetric matrix A. The permutation P keeps L
// sparse. CHOLMOD's supernodal method stores columns of L with the same pattern as dense blocks and
// factorizes them by BLAS. The numbers do not depend on the number of threads if BLAS uses one
// thread, as ATLAS does, with which Debian links Ceres.
class SparseCholesky {
 public:
  // Factorizes `matrix`, of which it reads the lower triangle. Calls `start` when P is found,
  // before the arithmetic starts, with the number of additions and multiplications that follow.
  // Throws std::bad_alloc if memory runs out.
  explicit SparseCholesky(const Eigen::SparseMatrix<double>& matrix,
                          const std::function<void(double operations)>& start = {});
  ~SparseCholesky();

  // False if a pivot was not positive.
  bool is_positive_definite() const;

  // v^T A^-1 v. Precondition: is_positive_definite(), and v has as many numbers as A has rows.
  // Throws std::bad_alloc if memory runs out.
  double inverse_form(const Eigen::VectorXd& v) const;

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

}  // namespace axial::pose
