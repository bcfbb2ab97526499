// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/control/target_points.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/order_statistics.h"
#include "pose/bundle/tracks.h"
#include "pose/control/target_shape.h"

namespace axial::pose {
namespace {

using Ray = refractive::AxialRay<double>;

std::vector<Ray> rays_of(const Bundle& bundle, std::span<const PhotographCamera> cameras,
                         const Target& target) {
  std::vector<Ray> rays;
  for (const TargetImage& image : target.images) {
    const BundleImage& of = bundle.images[image.image];
    rays.push_back(world_ray(cameras[of.camera], of.pose, image.pixel));
  }
  return rays;
}

// The observations of targets by image and source of the point.
std::map<std::pair<std::size_t, std::size_t>, Observation*> target_observations(Bundle& bundle) {
  std::map<std::pair<std::size_t, std::size_t>, Observation*> found;
  for (Observation& one : bundle.observations)
    if (bundle.points[one.point].is_target)
      found[{one.image, bundle.points[one.point].source}] = &one;
  return found;
}

constexpr double kElsewhere = 3;  // in units of the error of a photograph that agrees

struct MeasuredTarget {
  double error = 0;  // reprojection error [px]
  double sigma = 0;  // TargetImage::sigma
  // The part of the variance that is left in reprojection errors: a point takes three numbers of
  // its observations.
  double left = 1;
};

// The standard deviation [px] that all targets have besides their own. A squared error in units of
// its variance has the median 2 ln 2.
double common_sigma(std::span<const MeasuredTarget> measured) {
  constexpr double kLargest = 8, kStep = 1e-4;  // [px]
  if (measured.empty()) return 0;
  double low = 0, high = kLargest;
  while (high - low > kStep) {
    const double middle = (low + high) / 2;
    std::vector<double> ratios;
    for (const MeasuredTarget& one : measured)
      ratios.push_back(one.error * one.error /
                       (one.left * (one.sigma * one.sigma + middle * middle)));
    (upper_median(std::move(ratios)) > 2 * std::log(2.0) ? low : high) = middle;
  }
  return high > kStep ? (low + high) / 2 : 0;
}

// The photographs of a target that agree with the place where the rays of two of them meet. Empty
// if no two agree. `taken`: photographs that do not count.
struct Agreeing {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  std::vector<std::size_t> images;  // indices into Target::images
};

Agreeing most_agreeing(const Bundle& bundle, std::span<const PhotographCamera> cameras,
                       const Target& target, const std::vector<bool>& taken, double max_error) {
  constexpr std::size_t kMost = 40;  // photographs of which pairs are tried
  const std::vector<Ray> rays = rays_of(bundle, cameras, target);
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (!taken[i] && rays[i].direction.allFinite()) left.push_back(i);
  Agreeing best;
  for (std::size_t a = 0; a < std::min(left.size(), kMost); ++a)
    for (std::size_t b = a + 1; b < std::min(left.size(), kMost); ++b) {
      const auto place = triangulate(std::vector{rays[left[a]], rays[left[b]]});
      if (!place) continue;
      Agreeing found{*place, {}};
      for (const std::size_t i : left) {
        const BundleImage& of = bundle.images[target.images[i].image];
        if (reprojection_error(cameras[of.camera], of.pose, *place, target.images[i].pixel) <=
            max_error)
          found.images.push_back(i);
      }
      if (found.images.size() > best.images.size()) best = std::move(found);
    }
  return best;
}

}  // namespace

void add_targets(Bundle& bundle, std::span<Target> targets) {
  const std::vector<PhotographCamera> cameras = cameras_now(bundle);
  std::size_t source = 0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const BundlePoint& point : bundle.points) {
    source = std::max(source, point.source);
    middle += point.position / static_cast<double>(bundle.points.size());
  }
  for (Target& target : targets) {
    target.source = 0;
    if (target.images.size() < 2) continue;
    target.source = ++source;
    std::vector<Ray> rays = rays_of(bundle, cameras, target);
    std::erase_if(rays, [](const Ray& ray) { return !ray.direction.allFinite(); });
    for (const TargetImage& image : target.images) {
      Observation observation;
      observation.image = image.image;
      observation.point = bundle.points.size();
      observation.pixel = image.pixel;
      observation.target_sigma = 1;  // until correct_targets()
      bundle.observations.push_back(observation);
    }
    bundle.points.push_back({triangulate(rays).value_or(middle), source, true});
  }
}

void correct_targets(Bundle& bundle, std::span<const Target> targets) {
  const std::vector<PhotographCamera> cameras = cameras_now(bundle);
  const auto observations = target_observations(bundle);
  std::map<std::size_t, double> seen;  // number of observations by source
  for (const auto& [key, observation] : observations) ++seen[key.second];
  std::vector<MeasuredTarget> measured;
  std::vector<Observation*> order;
  for (const Target& target : targets) {
    if (!seen.contains(target.source)) continue;
    const Eigen::Vector3d& place = bundle.points[point_of(bundle, target.source)].position;
    const std::vector<Eigen::Vector2d> corrections =
        centre_corrections(bundle, cameras, target, place);
    const double left = std::max(0.25, 1 - 3 / (2 * seen[target.source]));
    for (std::size_t i = 0; i < target.images.size(); ++i) {
      const TargetImage& image = target.images[i];
      const auto found = observations.find({image.image, target.source});
      if (found == observations.end()) continue;
      found->second->pixel = image.pixel + corrections[i];
      const BundleImage& of = bundle.images[image.image];
      measured.push_back(
          {reprojection_error(cameras[of.camera], of.pose, place, found->second->pixel),
           image.sigma, left});
      order.push_back(found->second);
    }
  }
  constexpr double kLeast = 0.01;  // [px]
  const double common = common_sigma(measured);
  for (std::size_t i = 0; i < order.size(); ++i)
    order[i]->target_sigma = std::max(kLeast, std::hypot(common, measured[i].sigma));
}

std::vector<DoubleTarget> double_targets(const Bundle& bundle, std::span<const Target> targets,
                                         double max_error) {
  const std::vector<PhotographCamera> cameras = cameras_now(bundle);
  std::vector<DoubleTarget> found;
  for (std::size_t t = 0; t < targets.size(); ++t) {
    std::vector<bool> taken(targets[t].images.size());
    const Agreeing first = most_agreeing(bundle, cameras, targets[t], taken, max_error);
    for (const std::size_t i : first.images) taken[i] = true;
    const Agreeing second = most_agreeing(bundle, cameras, targets[t], taken, max_error);
    const bool elsewhere = std::ranges::all_of(second.images, [&](std::size_t i) {
      const TargetImage& image = targets[t].images[i];
      const BundleImage& of = bundle.images[image.image];
      return reprojection_error(cameras[of.camera], of.pose, first.place, image.pixel) >
             kElsewhere * max_error;
    });
    if (first.images.size() >= 2 && second.images.size() >= 2 && elsewhere)
      found.push_back(
          {t, first.images.size(), second.images.size(), (first.place - second.place).norm()});
  }
  return found;
}

void drop_targets(Bundle& bundle) {
  std::erase_if(bundle.observations, [&](const Observation& observation) {
    return bundle.points[observation.point].is_target;
  });
  // Targets stand behind all other points, so that indices stay right.
  std::erase_if(bundle.points, [](const BundlePoint& point) { return point.is_target; });
}

}  // namespace axial::pose
