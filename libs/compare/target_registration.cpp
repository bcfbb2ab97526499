// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/target_registration.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"

namespace axial::compare {
namespace {

using Eigen::Index;
using Indices = std::vector<std::size_t>;

constexpr double kMoved = 22;  // decrease of the sum of squares without a target that moved
constexpr double kSure = 9;    // increase of the sum without another target instead
constexpr double kLeastVariance = 1e-12;  // of a coordinate [m^2]
constexpr double kSteepest = 2;           // standard deviation along the normal of three targets

// The derivatives of places by a motion (rotation vector, translation). `offsets`: of the places
// from the centre of the motion.
Eigen::MatrixXd motion_columns(const Eigen::Matrix3Xd& offsets) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(offsets.size(), 6);
  for (Index i = 0; i < offsets.cols(); ++i)
    for (int k = 0; k < 3; ++k) {
      columns.block<3, 1>(3 * i, k) = Eigen::Vector3d::Unit(k).cross(offsets.col(i));
      columns(3 * i + k, 3 + k) = 1;
    }
  return columns;
}

// The covariance of a motion, in the units of the orthonormal `columns`, by which all targets have
// errors in common: the one with which the covariances between different targets become smallest.
Matrix6d common_motion(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& columns) {
  constexpr double kNotShown = 1e-6;
  Matrix6d right = columns.transpose() * covariance * columns;
  Eigen::MatrixXd equations = Eigen::MatrixXd::Identity(36, 36);
  for (Index i = 0; i < columns.rows(); i += 3) {
    const Eigen::Matrix<double, 3, 6> own = columns.middleRows<3>(i);
    const Matrix6d square = own.transpose() * own;
    right -= own.transpose() * covariance.block<3, 3>(i, i) * own;
    for (Index a = 0; a < 6; ++a)
      for (Index b = 0; b < 6; ++b) equations.block<6, 6>(6 * a, 6 * b) -= square(a, b) * square;
  }
  const EigenPairs pairs = symmetric_eigen(equations);
  const Eigen::VectorXd inverse =
      pairs.values.unaryExpr([](double value) { return value > kNotShown ? 1 / value : 0; });
  const Eigen::VectorXd solution =
      pairs.vectors * inverse.cwiseProduct(pairs.vectors.transpose() *
                                           Eigen::Map<const Eigen::VectorXd>(right.data(), 36));
  const Matrix6d motion = Eigen::Map<const Matrix6d>(solution.data());
  return 0.5 * (motion + motion.transpose());
}

// Limits the variances along the normal of the plane of three targets (register_targets()).
void limit_normal_variances(const Eigen::Matrix3Xd& places, Eigen::MatrixXd& covariance) {
  const Eigen::Vector3d normal =
      (places.col(1) - places.col(0)).cross(places.col(2) - places.col(0)).normalized();
  const Eigen::Matrix3d plane = Eigen::Matrix3d::Identity() - normal * normal.transpose();
  for (Index i = 0; i < 9; i += 3) {
    auto own = covariance.block<3, 3>(i, i);
    const double inside = SymmetricEigen3(Eigen::Matrix3d(plane * own * plane)).eigenvalues()(2);
    const double along = normal.dot(own * normal);
    const double most = kSteepest * kSteepest * std::max(inside, kLeastVariance);
    if (along > most) own -= (along - most) * normal * normal.transpose();
  }
}

// The covariance of a survey without the common motion, which is exact only for the places of this
// survey itself.
Eigen::MatrixXd relative_covariance(const Eigen::Matrix3Xd& places, const Eigen::MatrixXd& stated) {
  const Eigen::MatrixXd covariance = 0.5 * (stated + stated.transpose());
  const Eigen::Vector3d centre = places.rowwise().mean();
  const Eigen::MatrixXd columns = motion_columns(places.colwise() - centre);
  const Eigen::MatrixXd orthonormal =
      Eigen::HouseholderQR<Eigen::MatrixXd>(columns).householderQ() *
      Eigen::MatrixXd::Identity(columns.rows(), 6);
  Eigen::MatrixXd relative =
      covariance - orthonormal * common_motion(covariance, orthonormal) * orthonormal.transpose();
  if (places.cols() == 3) limit_normal_variances(places, relative);
  const EigenPairs pairs = symmetric_eigen(relative);
  return pairs.vectors * pairs.values.cwiseMax(kLeastVariance).asDiagonal() *
         pairs.vectors.transpose();
}

// The covariance of the differences of places. `rotation`: of the later survey.
Eigen::MatrixXd sum_of(const Eigen::MatrixXd& before, const Eigen::MatrixXd& after,
                       const Eigen::Matrix3d& rotation) {
  Eigen::MatrixXd sum = before;
  for (Index i = 0; i < before.rows(); i += 3)
    for (Index j = 0; j < before.cols(); j += 3)
      sum.block<3, 3>(i, j) += rotation * after.block<3, 3>(i, j) * rotation.transpose();
  return sum;
}

// The solution for some of the targets.
struct Fit {
  Similarity motion;
  Eigen::Vector3d centre;
  Matrix6d covariance;
  double chi_squared = 0;
  double scale = 1, scale_sigma = 0;
};

Eigen::Matrix3Xd places_of(const Eigen::Matrix3Xd& places, const Indices& used) {
  Eigen::Matrix3Xd result(3, static_cast<Index>(used.size()));
  for (std::size_t i = 0; i < used.size(); ++i)
    result.col(static_cast<Index>(i)) = places.col(static_cast<Index>(used[i]));
  return result;
}

Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& covariance, const Indices& used) {
  const auto count = static_cast<Index>(used.size());
  Eigen::MatrixXd result(3 * count, 3 * count);
  for (Index i = 0; i < count; ++i)
    for (Index j = 0; j < count; ++j)
      result.block<3, 3>(3 * i, 3 * j) =
          covariance.block<3, 3>(3 * static_cast<Index>(used[static_cast<std::size_t>(i)]),
                                 3 * static_cast<Index>(used[static_cast<std::size_t>(j)]));
  return result;
}

Eigen::Matrix3Xd moved_places(const Similarity& motion, const Eigen::Matrix3Xd& places) {
  return (motion.rotation * places).colwise() + motion.translation;
}

void turn(const Eigen::Vector3d& rotation, const Eigen::Vector3d& translation,
          const Eigen::Vector3d& centre, Similarity& motion) {
  const double angle = rotation.norm();
  Similarity step;
  if (angle > 0) step.rotation = Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
  step.translation = centre - step.rotation * centre + translation;
  motion = step.after(motion);
}

// Gauss-Newton steps from `motion`. `covariance`: of all targets.
Fit fitted(const CommonTargets& targets, const Indices& used, const Eigen::MatrixXd& covariance,
           const Similarity& motion) {
  constexpr int kSteps = 6;
  const Eigen::Matrix3Xd before = places_of(targets.before, used),
                         after = places_of(targets.after, used);
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance_of(covariance, used));
  Fit fit{motion, before.rowwise().mean(), {}};
  for (int step = 0;; ++step) {
    const Eigen::Matrix3Xd places = moved_places(fit.motion, after);
    const Eigen::Matrix3Xd offsets = places.colwise() - fit.centre;
    const Eigen::Matrix3Xd residuals = places - before;
    const Eigen::VectorXd right = factor.matrixL().solve(
        Eigen::Map<const Eigen::VectorXd>(residuals.data(), residuals.size()));
    Eigen::MatrixXd columns(residuals.size(), 7);
    columns << motion_columns(offsets),
        Eigen::Map<const Eigen::VectorXd>(offsets.data(), offsets.size());
    factor.matrixL().solveInPlace(columns);
    const Eigen::MatrixXd rigid = columns.leftCols(6);
    const Matrix6d normal = rigid.transpose() * rigid;
    const Eigen::LDLT<Matrix6d> solver(normal);
    const Vector6d change = -solver.solve(rigid.transpose() * right);
    if (step < kSteps) {
      turn(change.head<3>(), change.tail<3>(), fit.centre, fit.motion);
      continue;
    }
    fit.covariance = solver.solve(Matrix6d::Identity());
    fit.chi_squared = right.squaredNorm();
    // The scale that is left, with the motion that goes with it.
    const Eigen::VectorXd of_scale = columns.col(6);
    const Eigen::VectorXd free = of_scale - rigid * solver.solve(rigid.transpose() * of_scale);
    const double weight = free.squaredNorm();
    fit.scale = 1 - free.dot(right) / weight;
    fit.scale_sigma = 1 / std::sqrt(weight);
    return fit;
  }
}

Indices without(const Indices& all, std::size_t one) {
  Indices result = all;
  std::erase(result, one);
  return result;
}

// Whether the targets determine the rotation about each line.
bool are_wide(const CommonTargets& targets, const Indices& used) {
  constexpr double kLeastWidth = 0.01;
  return relative_width(places_of(targets.before, used)) > kLeastWidth &&
         relative_width(places_of(targets.after, used)) > kLeastWidth;
}

// Targets of which one moved. Empty: none did; one: this one did.
Indices find_moved(const CommonTargets& targets, const Indices& used,
                   const Eigen::MatrixXd& covariance, const Fit& fit) {
  if (used.size() < 4) return {};
  std::vector<double> left;
  for (const std::size_t one : used) {
    const Indices others = without(used, one);
    left.push_back(are_wide(targets, others)
                       ? fitted(targets, others, covariance, fit.motion).chi_squared
                       : fit.chi_squared);
  }
  const double least = *std::ranges::min_element(left);
  Indices suspects;
  if (fit.chi_squared - least <= kMoved) return suspects;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (left[i] - least < kSure) suspects.push_back(used[i]);
  return suspects;
}

// The sum of squares that is exceeded once in a thousand times (E. Wilson and M. Hilferty, 1931).
double largest_by_chance(int freedom) {
  const double part = 2.0 / (9 * freedom);
  return freedom * std::pow(1 - part + 3.09 * std::sqrt(part), 3);
}

void require_places(const CommonTargets& targets) {
  const auto count = static_cast<Index>(targets.labels.size());
  if (count < 3)
    fail("{} targets are in both surveys, but a registration needs three or more", count);
  const bool is_finite = targets.before.allFinite() && targets.after.allFinite() &&
                         targets.covariance_before.allFinite() &&
                         targets.covariance_after.allFinite();
  if (!is_finite) fail("a place of a target or its covariance is not finite");
}

// Error if the used targets do not determine the rotation about a line.
void require_width(const CommonTargets& targets, const Indices& used) {
  if (are_wide(targets, used)) return;
  std::string labels;
  for (const std::size_t i : used) labels += (labels.empty() ? "" : ", ") + targets.labels[i];
  fail("the targets {} lie on a line, about which the survey could turn", labels);
}

}  // namespace

TargetRegistration register_targets(const CommonTargets& targets) {
  require_places(targets);
  TargetRegistration result;
  result.used.resize(targets.labels.size());
  std::iota(result.used.begin(), result.used.end(), std::size_t{0});
  require_width(targets, result.used);
  Similarity motion = best_similarity(targets.after, targets.before, false);
  motion.scale = 1;  // without rounding
  const Eigen::MatrixXd of_before = relative_covariance(targets.before, targets.covariance_before);
  const Eigen::MatrixXd of_after = relative_covariance(targets.after, targets.covariance_after);
  Fit fit;
  for (;;) {
    const Eigen::MatrixXd covariance = sum_of(of_before, of_after, motion.rotation);
    fit = fitted(targets, result.used, covariance, motion);
    motion = fit.motion;
    Indices suspects = find_moved(targets, result.used, covariance, fit);
    const bool is_clear = suspects.size() == 1;
    if (!is_clear || 2 * (result.moved.size() + 1) >= targets.labels.size()) {
      result.doubtful = std::move(suspects);
      break;
    }
    result.moved.push_back(suspects.front());
    result.used = without(result.used, suspects.front());
    require_width(targets, result.used);
  }
  std::ranges::sort(result.moved);
  result.motion = fit.motion;
  result.centre = fit.centre;
  result.residuals = moved_places(fit.motion, targets.after) - targets.before;
  result.chi_squared = fit.chi_squared;
  result.freedom = 3 * static_cast<int>(result.used.size()) - 6;
  result.agrees = fit.chi_squared <= largest_by_chance(result.freedom);
  result.covariance = fit.covariance * (result.agrees ? 1 : fit.chi_squared / result.freedom);
  result.scale = fit.scale;
  result.scale_sigma = fit.scale_sigma;
  return result;
}

Registration on_map(const TargetRegistration& found, const map::MapFrame& frame,
                    const LocalFrame& mesh_frame) {
  Registration result;
  const Eigen::Matrix3d& axes = frame.axes;
  result.motion.rotation = axes * found.motion.rotation * axes.transpose();
  result.motion.centre = frame.to_map(mesh_frame.to_local(found.centre));
  result.motion.translation = axes * (found.motion(found.centre) - found.centre);
  Matrix6d turned = Matrix6d::Zero();
  turned.topLeftCorner<3, 3>() = turned.bottomRightCorner<3, 3>() = axes;
  result.covariance = turned * found.covariance * turned.transpose();
  result.determined = 6;
  result.share_used = static_cast<double>(found.used.size()) /
                      static_cast<double>(found.used.size() + found.moved.size());
  double squares = 0;
  for (const std::size_t i : found.used)
    squares += found.residuals.col(static_cast<Index>(i)).squaredNorm();
  result.residual_sigma = std::sqrt(squares / (3 * static_cast<double>(found.used.size())));
  return result;
}

}  // namespace axial::compare
