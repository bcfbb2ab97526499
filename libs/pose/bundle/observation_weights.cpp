// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/bundle/observation_weights.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/order_statistics.h"

namespace axial::pose {
namespace {

constexpr std::size_t kClasses = 8, kLeastInClass = 200;
constexpr double kLargestRatio = 4;

// The smallest values of all classes but the first. Equal values are in one class.
std::vector<double> borders_of(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t classes = std::min(kClasses, values.size() / kLeastInClass);
  std::vector<double> borders;
  for (std::size_t i = 1; i < classes; ++i) {
    const double border = values[i * values.size() / classes];
    if (border > (borders.empty() ? values.front() : borders.back())) borders.push_back(border);
  }
  return borders;
}

std::size_t class_of(double value, const std::vector<double>& borders) {
  return static_cast<std::size_t>(std::ranges::upper_bound(borders, value) - borders.begin());
}

// Multiplies Observation::sigma by the relative errors of the classes of `values`, which has a
// value for each observation: 0 or less: not known.
void weigh_by(std::span<const double> values, Bundle& bundle) {
  const std::vector<double> errors = reprojection_errors(bundle);
  const auto counts = [&](std::size_t i) { return values[i] > 0 && std::isfinite(errors[i]); };
  const auto error = [&](std::size_t i) { return errors[i] / bundle.observations[i].sigma; };
  std::vector<double> known, all;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!counts(i)) continue;
    known.push_back(values[i]);
    all.push_back(error(i));
  }
  const std::vector<double> borders = borders_of(std::move(known));
  if (borders.empty()) return;
  std::vector<std::vector<double>> of_class(borders.size() + 1);
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (counts(i)) of_class[class_of(values[i], borders)].push_back(error(i));
  const double median = upper_median(std::move(all));
  if (!(median > 0)) return;
  std::vector<double> sigmas;
  for (std::vector<double>& some : of_class)
    sigmas.push_back(
        std::clamp(upper_median(std::move(some)) / median, 1 / kLargestRatio, kLargestRatio));
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (values[i] > 0) bundle.observations[i].sigma *= sigmas[class_of(values[i], borders)];
}

}  // namespace

void weigh_by_size(Bundle& bundle) {
  std::vector<double> sizes;
  for (Observation& observation : bundle.observations) {
    observation.sigma = 1;
    sizes.push_back(observation.size);
  }
  weigh_by(sizes, bundle);
}

void weigh_by_radius(Bundle& bundle) {
  const std::vector<PhotographCamera> cameras = cameras_now(bundle);
  std::vector<double> radii;
  for (const Observation& observation : bundle.observations) {
    const PhotographCamera& camera = cameras[bundle.images[observation.image].camera];
    const double radius = (observation.pixel - camera.principal_point()).norm();
    radii.push_back(observation.target_sigma > 0 ? 0 : radius);
  }
  weigh_by(radii, bundle);
}

}  // namespace axial::pose
