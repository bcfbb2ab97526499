// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/adjust/adjust.h"

#include <ceres/iteration_callback.h>
#include <ceres/solver.h>
#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "pose/adjust/adjust_problem.h"

namespace axial::pose {
namespace {

// The damping of the solver falls by a factor of three with each iteration. From the solver's own
// initial value, a survey of many images needs ten iterations until the damping no longer hinders
// the bending of the whole block, which reprojection errors determine weakly. Many images determine
// all other directions well, so the first step may be long. If a step raises the cost, the solver
// rejects it and damps more.
constexpr double kLongSteps = 1e9;

// An adjustment has arrived when an iteration changes the cost by less than this part. A smaller
// part would be the noise of the projections, which are iterations themselves.
constexpr double kLeastRelativeGain = 1e-8;

// The damping is bounded from below, so that the equations can be solved where nothing determines
// the scale.
constexpr double kLongestSteps = 1e10;

// What an iteration must gain at least, of half the cost.
struct LeastGain {
  double with_little_damping = 0;
  double with_least_damping = 0;
};

// Reports the iterations. Ends the adjustment when an iteration gains less than `least`, or with
// little damping less than kLeastRelativeGain of the cost. The gain of a strongly damped step tells
// nothing about the distance to the minimum. With the least damping, two iterations in a row must
// gain less.
class Iterations : public ceres::IterationCallback {
 public:
  Iterations(const AdjustSink& sink, const Context& context, const LeastGain& least)
      : sink_(sink), context_(context), least_(least) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& iteration) override {
    if (context_.stop_requested()) return ceres::SOLVER_ABORT;
    if (sink_) sink_({iteration.iteration, iteration.cost, iteration.iteration_time_in_seconds});
    return iteration.iteration > 0 && has_arrived(iteration) ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
                                                             : ceres::SOLVER_CONTINUE;
  }

 private:
  bool has_arrived(const ceres::IterationSummary& iteration) {
    const double least = std::max(least_.with_little_damping, kLeastRelativeGain * iteration.cost);
    // A step that is rejected although it hardly changes the cost is too short to lower it.
    if (!iteration.step_is_successful)
      return iteration.step_is_valid &&
             std::abs(iteration.cost_change) < kLeastRelativeGain * iteration.cost;
    const double radius = iteration.trust_region_radius;
    const bool gains_little =
        iteration.cost_change < least_.with_least_damping && radius >= kLongestSteps;
    const bool gained_little = std::exchange(gained_little_, gains_little);
    return (iteration.cost_change < least && radius > kLongSteps / 1000) ||
           (gains_little && gained_little);
  }

  const AdjustSink& sink_;
  const Context& context_;
  LeastGain least_;
  bool gained_little_ = false;  // of the iteration before
};

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
  options.max_trust_region_radius = kLongestSteps;
  options.logging_type = ceres::SILENT;
  return options;
}

// Outliers may take all iterations (AdjustOptions::gain_of_outliers).
bool has_converged(const ceres::Solver::Summary& summary, double gain_of_outliers) {
  return summary.termination_type != ceres::NO_CONVERGENCE ||
         summary.iterations.back().cost_change < gain_of_outliers;
}

}  // namespace

AdjustReport adjust(Bundle& bundle, const AdjustOptions& options, const AdjustSink& sink,
                    const Context& context) {
  AdjustProblem adjusted(bundle, options);
  ceres::Solver::Options solver = solver_options(adjusted, options.max_iterations);
  const bool many = !options.poses_known && adjusted.pose_count() >= options.many_images;
  if (many) solver.initial_trust_region_radius = kLongSteps;
  if (options.starts_close) solver.initial_trust_region_radius = kLongestSteps;
  Iterations iterations(
      sink, context,
      many ? LeastGain{options.least_gain, 0} : LeastGain{0, options.gain_of_outliers});
  solver.callbacks.push_back(&iterations);
  ceres::Solver::Summary summary;
  FLAGS_minloglevel = google::GLOG_FATAL;  // the Error below states a failure in one line
  ceres::Solve(solver, &adjusted.problem(), &summary);
  context.check_stop();
  if (!summary.IsSolutionUsable()) fail("bundle adjustment: {}", summary.message);
  adjusted.write_back(bundle);
  return {has_converged(summary, options.gain_of_outliers),
          static_cast<int>(summary.iterations.size()), summary.initial_cost, summary.final_cost};
}

}  // namespace axial::pose
