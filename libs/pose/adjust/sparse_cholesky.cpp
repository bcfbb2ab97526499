// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/adjust/sparse_cholesky.h"

#include <cholmod.h>

#include <new>

#include "base/error.h"

namespace axial::pose {
namespace {

// Indices of 64 bits, because the factor of a large survey can have more than 2^31 entries.
using LowerTriangle = Eigen::SparseMatrix<double, Eigen::ColMajor, SuiteSparse_long>;

cholmod_sparse view_of(LowerTriangle& matrix) {
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(matrix.cols());
  view.nzmax = static_cast<std::size_t>(matrix.nonZeros());
  view.p = matrix.outerIndexPtr();
  view.i = matrix.innerIndexPtr();
  view.x = matrix.valuePtr();
  view.stype = -1;  // symmetric, with the lower triangle
  view.itype = CHOLMOD_LONG;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = view.packed = true;
  return view;
}

cholmod_dense view_of(Eigen::VectorXd& vector) {
  cholmod_dense view{};
  view.nrow = view.nzmax = view.d = static_cast<std::size_t>(vector.size());
  view.ncol = 1;
  view.x = vector.data();
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

}  // namespace

struct SparseCholesky::Factor {
  Factor() {
    cholmod_l_start(&common);
    common.print = 0;  // CHOLMOD would print errors to the standard output
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.quick_return_if_not_posdef = true;
  }
  ~Factor() {
    cholmod_l_free_factor(&factor, &common);
    cholmod_l_finish(&common);
  }
  Factor(const Factor&) = delete;
  Factor& operator=(const Factor&) = delete;

  // Throws if the last call failed.
  void check() const {
    if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    if (common.status < CHOLMOD_OK) fail("CHOLMOD failed with status {}", common.status);
  }

  // The solution of the equations of `system`: CHOLMOD_A solves with the matrix, CHOLMOD_P
  // multiplies by P, CHOLMOD_L solves with L.
  Eigen::VectorXd solve(int system, Eigen::VectorXd right) {
    cholmod_dense view = view_of(right);
    cholmod_dense* solution = cholmod_l_solve(system, factor, &view, &common);
    check();
    right =
        Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(solution->x), right.size());
    cholmod_l_free_dense(&solution, &common);
    return right;
  }

  cholmod_common common{};
  cholmod_factor* factor = nullptr;
};

SparseCholesky::SparseCholesky(const Eigen::SparseMatrix<double>& matrix,
                               const std::function<void(double operations)>& start)
    : factor_(std::make_unique<Factor>()) {
  LowerTriangle lower = matrix.triangularView<Eigen::Lower>();
  cholmod_sparse view = view_of(lower);
  factor_->factor = cholmod_l_analyze(&view, &factor_->common);
  factor_->check();
  if (start) start(factor_->common.fl);
  cholmod_l_factorize(&view, factor_->factor, &factor_->common);
  factor_->check();
}

SparseCholesky::~SparseCholesky() = default;

bool SparseCholesky::is_positive_definite() const {
  return factor_->factor->minor == factor_->factor->n;
}

Eigen::VectorXd SparseCholesky::solve(const Eigen::VectorXd& v) const {
  return factor_->solve(CHOLMOD_A, v);
}

double SparseCholesky::inverse_form(const Eigen::VectorXd& v) const {
  return factor_->solve(CHOLMOD_L, factor_->solve(CHOLMOD_P, v)).squaredNorm();
}

}  // namespace axial::pose
