// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/adjust/depth_sigma.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"
#include "base/order_statistics.h"
#include "pose/adjust/adjust.h"
#include "pose/adjust/uncertainty.h"
#include "scene/decompositions.h"

namespace axial::pose {
namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();

// Columns by which the numbers change together by one standard deviation, independently of the
// other columns.
Eigen::MatrixXd independent_changes(const Eigen::MatrixXd& covariance) {
  // Numbers have different units.
  const Eigen::VectorXd sigmas = covariance.diagonal().cwiseSqrt();
  const Eigen::MatrixXd correlation =
      sigmas.cwiseInverse().asDiagonal() * covariance * sigmas.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation);
  return sigmas.asDiagonal() * solver.eigenvectors() *
         solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

// Places and points for the present numbers of the cameras.
Bundle adjusted(Bundle bundle, const Context& context) {
  AdjustOptions fixed;
  fixed.max_iterations = 50;
  fixed.least_gain = 1e-5;
  fixed.many_images = 1;  // ends by least_gain
  adjust(bundle, fixed, {}, context);
  return bundle;
}

std::vector<std::size_t> images_of(const Bundle& bundle) {
  std::vector<bool> seen(bundle.images.size());
  for (const Observation& observation : bundle.observations) seen[observation.image] = true;
  std::vector<std::size_t> images;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen[i]) images.push_back(i);
  return images;
}

// The median change of the distances of observed points, after the similarity of the centres.
double change_of_distances(const Bundle& before, const Bundle& after,
                           const std::vector<std::size_t>& images) {
  Eigen::Matrix3Xd from(3, static_cast<Eigen::Index>(images.size())), to = from;
  for (std::size_t i = 0; i < images.size(); ++i) {
    from.col(static_cast<Eigen::Index>(i)) = after.images[images[i]].pose.centre;
    to.col(static_cast<Eigen::Index>(i)) = before.images[images[i]].pose.centre;
  }
  const double scale = best_similarity(from, to).scale;
  std::vector<double> changes;
  for (const Observation& observation : before.observations) {
    const auto distance = [&](const Bundle& bundle) {
      return (bundle.points[observation.point].position -
              bundle.images[observation.image].pose.centre)
          .norm();
    };
    changes.push_back(scale * distance(after) / distance(before) - 1);
  }
  return std::abs(upper_median(std::move(changes)));
}

std::optional<Bundle> with_changes(Bundle bundle, const NumbersCovariance& numbers,
                                   const Eigen::VectorXd& changes, const Context& context) {
  for (std::size_t i = 0; i < numbers.numbers.size(); ++i)
    bundle.cameras[numbers.numbers[i].camera].change(numbers.numbers[i].index) +=
        changes(static_cast<Eigen::Index>(i));
  for (BundleCamera& camera : bundle.cameras)
    if (camera.same_as) camera.change = bundle.cameras[*camera.same_as].change;
  try {
    return adjusted(std::move(bundle), context);
  } catch (const Error&) {
    return std::nullopt;  // no port has these numbers
  }
}

// The numbers of cameras that took photographs.
std::size_t free_numbers(const Bundle& bundle, const AdjustOptions& options) {
  std::vector<bool> observed(bundle.cameras.size());
  for (const std::size_t image : images_of(bundle)) observed[bundle.images[image].camera] = true;
  std::size_t count = 0;
  for (std::size_t i = 0; i < bundle.cameras.size(); ++i) {
    const BundleCamera& camera = bundle.cameras[i];
    if (observed[i] && !camera.same_as)
      count += static_cast<std::size_t>(std::ranges::count(options.unknowns(camera).free, true));
  }
  return count;
}

}  // namespace

double depth_sigma(const Bundle& bundle, const AdjustOptions& options, const Context& context) {
  const NumbersCovariance numbers = covariance_of_numbers(bundle, options);
  if (numbers.numbers.size() < free_numbers(bundle, options)) return kNothing;
  if (numbers.numbers.empty()) return 0;
  const Context silent({}, context.stop_token());
  const Bundle part =
      adjusted(most_observed(bundle, std::max<std::size_t>(1500, 10 * bundle.images.size()), 2,
                             [](std::size_t) { return true; }),
               silent);
  const std::vector<std::size_t> images = images_of(part);
  if (images.size() < 3) return kNothing;
  const Eigen::MatrixXd changes = independent_changes(numbers.covariance);
  double variance = 0;
  for (Eigen::Index k = 0; k < changes.cols(); ++k) {
    auto moved = with_changes(part, numbers, changes.col(k), silent);
    if (!moved) moved = with_changes(part, numbers, -changes.col(k), silent);
    if (!moved) return kNothing;
    variance += std::pow(change_of_distances(part, *moved, images), 2);
  }
  return std::sqrt(variance);
}

}  // namespace axial::pose
