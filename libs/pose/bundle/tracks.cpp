// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/bundle/tracks.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/parallel.h"
#include "refractive/nearest_point.h"

namespace axial::pose {
namespace {

using Ray = refractive::AxialRay<double>;

// The ray in water of every observation, in the world frame. An observation whose pixel is the
// image of no direction gets NaN.
std::vector<Ray> world_rays(const Bundle& bundle) {
  const std::vector<PhotographCamera> cameras = cameras_now(bundle);
  std::vector<Ray> rays(bundle.observations.size());
  const auto set_ray = [&](std::size_t i) {
    const Observation& observation = bundle.observations[i];
    const BundleImage& image = bundle.images[observation.image];
    rays[i] = world_ray(cameras[image.camera], image.pose, observation.pixel);
  };
  parallel_for(rays.size(), set_ray, kPointGrain);
  return rays;
}

std::vector<std::vector<std::size_t>> observations_by_point(const Bundle& bundle) {
  return observations_of_each(bundle.observations, &Observation::point, bundle.points.size());
}

std::vector<Ray> rays_of(std::span<const std::size_t> list, const std::vector<Ray>& rays) {
  std::vector<Ray> own;
  for (const std::size_t observation : list) own.push_back(rays[observation]);
  return own;
}

// Observations and their rays, in the same order.
struct Seen {
  std::vector<Observation>& observations;
  std::vector<Ray> rays;

  template <class Kept>
  void keep(const Kept& kept) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < observations.size(); ++i) {
      if (!kept(observations[i])) continue;
      observations[count] = observations[i];
      rays[count++] = rays[i];
    }
    observations.resize(count);
    rays.resize(count);
  }
};

// Removes the points that are not kept, and their observations, and renumbers the other points.
void drop_points(Bundle& bundle, Seen& seen, const std::vector<bool>& kept) {
  std::vector<std::size_t> place(kept.size());
  std::vector<BundlePoint> points;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    place[i] = points.size();
    if (kept[i]) points.push_back(bundle.points[i]);
  }
  seen.keep([&](const Observation& observation) { return kept[observation.point]; });
  for (Observation& observation : bundle.observations) observation.point = place[observation.point];
  bundle.points = std::move(points);
}

bool seen_by_two_images(std::span<const std::size_t> list, const Bundle& bundle) {
  return std::ranges::any_of(list, [&](std::size_t observation) {
    return bundle.observations[observation].image != bundle.observations[list.front()].image;
  });
}

void drop_weak_points(Bundle& bundle, Seen& seen, double min_angle) {
  std::vector<bool> kept;
  for (const auto& list : observations_by_point(bundle))
    kept.push_back(seen_by_two_images(list, bundle) &&
                   widest_angle(rays_of(list, seen.rays)) >= min_angle);
  drop_points(bundle, seen, kept);
}

void drop_weak_images(const Bundle& bundle, Seen& seen, std::size_t min_observations) {
  const std::vector<std::size_t> counts = observations_by_image(bundle);
  seen.keep([&](const Observation& observation) {
    return counts[observation.image] >= min_observations;
  });
}

}  // namespace

Ray world_ray(const PhotographCamera& camera, const Pose& pose, const Eigen::Vector2d& pixel) {
  const Ray ray = camera.ray(pixel);
  return {pose.to_world(ray.origin), pose.rotation.transpose() * ray.direction};
}

double widest_angle(std::span<const Ray> rays) {
  double smallest_cosine = 1;
  for (std::size_t i = 0; i < rays.size(); ++i)
    for (std::size_t j = i + 1; j < rays.size(); ++j)
      smallest_cosine = std::min(smallest_cosine, rays[i].direction.dot(rays[j].direction));
  return std::acos(std::clamp(smallest_cosine, -1.0, 1.0));
}

std::optional<Eigen::Vector3d> triangulate(std::span<const Ray> rays) {
  const auto equations = refractive::nearest_point_equations(rays);
  const Eigen::LDLT<Eigen::Matrix3d> solver(equations.normal);
  constexpr double kParallel = 1e-8;  // squared sine of an angle of 0.006 degrees
  if (rays.size() < 2 || !(solver.vectorD().minCoeff() > kParallel)) return {};
  const Eigen::Vector3d point = solver.solve(equations.right);
  for (const Ray& ray : rays)
    if (!(ray.direction.dot(point - ray.origin) > 0)) return {};
  return point;
}

void triangulate(Bundle& bundle) {
  const std::vector<Ray> rays = world_rays(bundle);
  const auto lists = observations_by_point(bundle);
  const auto place = [&](std::size_t i) {
    std::vector<Ray> own;
    for (const std::size_t observation : lists[i])
      if (rays[observation].direction.allFinite()) own.push_back(rays[observation]);
    if (const auto point = triangulate(own)) bundle.points[i].position = *point;
  };
  parallel_for(lists.size(), place, kPointGrain);
}

std::size_t drop_repeated(Bundle& bundle) {
  const std::vector<double> errors = reprojection_errors(bundle);
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> nearest;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const Observation& observation = bundle.observations[i];
    const auto [best, added] = nearest.try_emplace({observation.point, observation.image}, i);
    if (!added && errors[i] < errors[best->second]) best->second = i;
  }
  std::size_t i = 0;
  return std::erase_if(bundle.observations, [&](const Observation& observation) {
    return nearest.at({observation.point, observation.image}) != i++;
  });
}

std::size_t filter(Bundle& bundle, const TrackLimits& limits, DropCounts* counts) {
  DropCounts dropped;
  const std::size_t before = bundle.observations.size();
  const std::vector<double> errors = reprojection_errors(bundle);
  std::vector<Observation> believed;
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (errors[i] <= limits.max_error) believed.push_back(bundle.observations[i]);
  bundle.observations = std::move(believed);
  dropped.errors = before - bundle.observations.size();
  Seen seen{bundle.observations, world_rays(bundle)};
  for (std::size_t left = bundle.observations.size() + 1; left != bundle.observations.size();) {
    left = bundle.observations.size();
    drop_weak_images(bundle, seen, limits.min_observations);
    dropped.weak_images += left - bundle.observations.size();
    const std::size_t of_strong_images = bundle.observations.size();
    drop_weak_points(bundle, seen, limits.min_angle * std::numbers::pi / 180);
    dropped.weak_points += of_strong_images - bundle.observations.size();
  }
  if (counts) {
    counts->errors += dropped.errors;
    counts->weak_images += dropped.weak_images;
    counts->weak_points += dropped.weak_points;
  }
  return before - bundle.observations.size();
}

}  // namespace axial::pose
