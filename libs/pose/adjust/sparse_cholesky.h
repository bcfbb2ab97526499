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
// factorizes them by BLAS. CHOLMOD may divide its work among up to four threads; this does not
// change the sums. Debian's libraries take their BLAS from ATLAS, which starts no threads. With a
// BLAS that starts threads, the last digits can depend on their number.
class SparseCholesky {
 public:
  // Factorizes `matrix`, of which it reads the lower triangle. Calls `start` when P is found,
  // before the arithmetic starts, with the number of additions and multiplications that follow.
  // Throws std::bad_alloc if memory runs out, and an Error for any other failure of CHOLMOD.
  explicit SparseCholesky(const Eigen::SparseMatrix<double>& matrix,
                          const std::function<void(double operations)>& start = {});
  ~SparseCholesky();

  // False if a pivot was not positive.
  bool is_positive_definite() const;

  // A^-1 v. Precondition and errors as for inverse_form().
  Eigen::VectorXd solve(const Eigen::VectorXd& v) const;

  // v^T A^-1 v. Precondition: is_positive_definite(), and v has as many numbers as A has rows.
  // Throws std::bad_alloc if memory runs out.
  double inverse_form(const Eigen::VectorXd& v) const;

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

}  // namespace axial::pose
