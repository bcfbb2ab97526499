// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/bundle/bundle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/order_statistics.h"
#include "base/parallel.h"

namespace axial::pose {
std::vector<PhotographCamera> cameras_now(const Bundle& bundle) {
  std::vector<PhotographCamera> cameras;
  cameras.reserve(bundle.cameras.size());
  for (const BundleCamera& camera : bundle.cameras) cameras.emplace_back(camera.now());
  return cameras;
}

std::size_t point_of(const Bundle& bundle, std::size_t source) {
  const auto found = std::find_if(bundle.points.begin(), bundle.points.end(),
                                  [&](const BundlePoint& point) { return point.source == source; });
  if (found == bundle.points.end())
    fail("point {} is not in the model, or does not fit the refractive cameras", source);
  return static_cast<std::size_t>(found - bundle.points.begin());
}

void move_places(Bundle& bundle, const Similarity& similarity) {
  for (BundleImage& image : bundle.images) image.pose = similarity(image.pose);
  for (BundlePoint& point : bundle.points) point.position = similarity(point.position);
}

std::vector<std::size_t> observations_by_image(const Bundle& bundle) {
  std::vector<std::size_t> counts(bundle.images.size());
  for (const Observation& observation : bundle.observations) ++counts[observation.image];
  return counts;
}

bool has_targets(const Bundle& bundle) {
  return std::ranges::any_of(bundle.points, &BundlePoint::is_target);
}

std::vector<std::vector<std::size_t>> observations_of_each(
    std::span<const Observation> observations, std::size_t Observation::*of, std::size_t count) {
  std::vector<std::vector<std::size_t>> lists(count);
  for (std::size_t i = 0; i < observations.size(); ++i) lists[observations[i].*of].push_back(i);
  return lists;
}

Bundle most_observed(const Bundle& bundle, std::size_t most, std::size_t least,
                     const std::function<bool(std::size_t image)>& takes) {
  std::vector<std::size_t> seen(bundle.points.size()), order;
  for (const Observation& observation : bundle.observations)
    if (takes(observation.image)) ++seen[observation.point];
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen[i] >= least && !bundle.points[i].is_target) order.push_back(i);
  std::ranges::stable_sort(order, std::greater{}, [&](std::size_t i) { return seen[i]; });
  order.resize(std::min(order.size(), most));
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> place(seen.size(), kNone);
  Bundle part{bundle.cameras, bundle.images, {}, {}};
  for (const std::size_t point : order) {
    place[point] = part.points.size();
    part.points.push_back(bundle.points[point]);
  }
  for (Observation observation : bundle.observations) {
    if (!takes(observation.image) || place[observation.point] == kNone) continue;
    observation.point = place[observation.point];
    part.observations.push_back(observation);
  }
  return part;
}

double reprojection_error(const PhotographCamera& camera, const Pose& pose,
                          const Eigen::Vector3d& point, const Eigen::Vector2d& pixel) {
  const PhotographImage image = camera.image(pose.to_camera(point));
  if (!image.visible) return std::numeric_limits<double>::infinity();
  return (image.pixel - pixel).norm();
}

std::vector<double> reprojection_errors(const Bundle& bundle) {
  const std::vector<PhotographCamera> cameras = cameras_now(bundle);
  std::vector<double> errors(bundle.observations.size());
  const auto set_error = [&](std::size_t i) {
    const Observation& observation = bundle.observations[i];
    const BundleImage& image = bundle.images[observation.image];
    errors[i] = reprojection_error(cameras[image.camera], image.pose,
                                   bundle.points[observation.point].position, observation.pixel);
  };
  parallel_for(errors.size(), set_error, kPointGrain);
  return errors;
}

double median_distance(const Bundle& bundle) {
  std::vector<double> distances;
  for (const Observation& observation : bundle.observations)
    distances.push_back(
        (bundle.points[observation.point].position - bundle.images[observation.image].pose.centre)
            .norm());
  if (distances.empty()) fail("the model has no observations");
  return upper_median(std::move(distances));
}

std::vector<std::vector<double>> reprojection_errors_by_image(const Bundle& bundle) {
  std::vector<std::vector<double>> errors(bundle.images.size());
  const std::vector<double> all = reprojection_errors(bundle);
  for (std::size_t i = 0; i < all.size(); ++i)
    errors[bundle.observations[i].image].push_back(all[i]);
  return errors;
}

double root_mean_square(std::span<const double> errors) {
  double sum = 0;
  std::size_t count = 0;
  for (const double error : errors) {
    if (!std::isfinite(error)) continue;
    sum += error * error;
    ++count;
  }
  return count == 0 ? 0 : std::sqrt(sum / static_cast<double>(count));
}

}  // namespace axial::pose
