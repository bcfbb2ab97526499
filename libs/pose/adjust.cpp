// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/adjust.h"

#include <ceres/solver.h>

#include "base/error.h"
#include "pose/adjust_problem.h"

namespace axial::pose {
namespace {

ceres::Solver::Options solver_options(AdjustProblem& adjusted, int max_iterations) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  const std::vector<double*> points = adjusted.point_blocks(), cameras = adjusted.camera_blocks();
  if (!points.empty() && !cameras.empty()) {
    options.linear_solver_type = ceres::SPARSE_SCHUR;
    auto* ordering = new ceres::ParameterBlockOrdering;
    for (double* block : points) ordering->AddElementToGroup(block, 0);
    for (double* block : cameras) ordering->AddElementToGroup(block, 1);
    options.linear_solver_ordering.reset(ordering);
  }
  options.num_threads = 1;
  options.max_num_iterations = max_iterations;
  // Often refraction alone determines the scale: it converges last and changes the cost least.
  options.function_tolerance = 1e-10;
  options.gradient_tolerance = 0;
  options.parameter_tolerance = 1e-12;
  // Bounds the damping from below, so that the equations can be solved where nothing determines the
  // scale.
  options.max_trust_region_radius = 1e10;
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace

const Unknowns& AdjustOptions::unknowns(const BundleCamera& camera) const {
  const auto& port = camera.measured.port;
  const bool dome = port && std::holds_alternative<refractive::DomePort<double>>(*port);
  if (dome && of_domes) return *of_domes;
  return *this;
}

AdjustReport adjust(Bundle& bundle, const AdjustOptions& options) {
  AdjustProblem adjusted(bundle, options);
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(adjusted, options.max_iterations), &adjusted.problem(), &summary);
  if (!summary.IsSolutionUsable()) fail("bundle adjustment: {}", summary.message);
  adjusted.write_back(bundle);
  return {summary.termination_type == ceres::CONVERGENCE,
          static_cast<int>(summary.iterations.size()), summary.initial_cost, summary.final_cost};
}

}  // namespace axial::pose
