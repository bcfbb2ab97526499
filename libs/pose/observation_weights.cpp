// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/observation_weights.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/order_statistics.h"

namespace axial::pose {
namespace {

constexpr std::size_t kClasses = 8, kLeastInClass = 200;
constexpr double kLargestRatio = 4;

// The smallest sizes of all classes but the first. Equal sizes are in one class.
std::vector<float> borders_of(std::vector<float> sizes) {
  std::ranges::sort(sizes);
  const std::size_t classes = std::min(kClasses, sizes.size() / kLeastInClass);
  std::vector<float> borders;
  for (std::size_t i = 1; i < classes; ++i) {
    const float border = sizes[i * sizes.size() / classes];
    if (border > (borders.empty() ? sizes.front() : borders.back())) borders.push_back(border);
  }
  return borders;
}

std::size_t class_of(float size, const std::vector<float>& borders) {
  return static_cast<std::size_t>(std::ranges::upper_bound(borders, size) - borders.begin());
}

}  // namespace

void weigh_by_size(Bundle& bundle) {
  const std::vector<double> errors = reprojection_errors(bundle);
  std::vector<float> sizes;
  std::vector<double> all;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    bundle.observations[i].sigma = 1;
    if (!(bundle.observations[i].size > 0) || !std::isfinite(errors[i])) continue;
    sizes.push_back(bundle.observations[i].size);
    all.push_back(errors[i]);
  }
  const std::vector<float> borders = borders_of(std::move(sizes));
  if (borders.empty()) return;
  std::vector<std::vector<double>> of_class(borders.size() + 1);
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (const float size = bundle.observations[i].size; size > 0 && std::isfinite(errors[i]))
      of_class[class_of(size, borders)].push_back(errors[i]);
  const double median = upper_median(std::move(all));
  if (!(median > 0)) return;
  std::vector<double> sigmas;
  for (std::vector<double>& some : of_class)
    sigmas.push_back(
        std::clamp(upper_median(std::move(some)) / median, 1 / kLargestRatio, kLargestRatio));
  for (Observation& observation : bundle.observations)
    if (observation.size > 0) observation.sigma = sigmas[class_of(observation.size, borders)];
}

}  // namespace axial::pose
