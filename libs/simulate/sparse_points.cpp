// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulate/sparse_points.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>

#include "base/parallel.h"
#include "simulate/noise.h"

namespace axial::simulate {
namespace {

constexpr std::ptrdiff_t kMostTested = 400;

std::optional<Eigen::Vector2d> observe(const RayScene& scene, const Lens& lens, const View& view,
                                       const Eigen::Vector3d& point) {
  const Eigen::Vector3d in_camera = view.rotation * (point - view.centre);
  if (!(in_camera.z() > 0)) return std::nullopt;
  const Eigen::Vector2d pixel = pixel_of(lens, in_camera);
  if (pixel.x() < 0 || pixel.y() < 0 || pixel.x() > lens.width - 1 || pixel.y() > lens.height - 1)
    return std::nullopt;
  // A point beyond the field of the lens can be projected into the image, but at a wrong pixel.
  if (lens.bend && direction_of(lens, pixel.x(), pixel.y()).dot(in_camera.normalized()) < 1 - 1e-9)
    return std::nullopt;
  const double range = in_camera.norm();
  const Eigen::Vector3d direction = (point - view.centre) / range;
  // The point lies on the surface, so the last thousandth of the way is not tested.
  if (scene.blocked(view.centre, direction, 0, 0.999 * range)) return std::nullopt;
  return pixel;
}

// The views, by index, that are tested for the points of `view`: the kMostTested nearest, in
// ascending order.
std::vector<std::size_t> views_near(std::span<const View> views, const View& view) {
  std::vector<std::size_t> near(views.size());
  std::iota(near.begin(), near.end(), std::size_t{0});
  if (std::ssize(near) <= kMostTested) return near;
  std::vector<double> distances;
  for (const View& other : views) distances.push_back((other.centre - view.centre).squaredNorm());
  const auto nearer = [&](std::size_t a, std::size_t b) {
    return distances[a] != distances[b] ? distances[a] < distances[b] : a < b;
  };
  const auto end = near.begin() + kMostTested;
  std::nth_element(near.begin(), end, near.end(), nearer);
  near.erase(end, near.end());
  std::ranges::sort(near);
  return near;
}

}  // namespace

std::vector<SparsePoint> true_points(const RayScene& scene, const Shader& shader, const Lens& lens,
                                     std::span<const View> views, int per_view,
                                     std::uint64_t seed) {
  const double spacing = std::sqrt(1.0 * lens.width * lens.height / std::max(1, per_view));
  const auto columns = static_cast<std::size_t>(std::max(1.0, lens.width / spacing));
  const auto rows = static_cast<std::size_t>(std::max(1.0, lens.height / spacing));
  std::vector<SparsePoint> points(views.size() * rows * columns);
  std::vector<std::vector<std::size_t>> tested(views.size());
  parallel_for(views.size(), [&](std::size_t k) { tested[k] = views_near(views, views[k]); });
  parallel_for(points.size(), [&](std::size_t i) {
    const std::size_t cell = i % (rows * columns);
    const View& view = views[i / (rows * columns)];
    const double u = (static_cast<double>(cell % columns) + uniform(seed, 2 * i)) * spacing;
    const double v = (static_cast<double>(cell / columns) + uniform(seed, 2 * i + 1)) * spacing;
    const SceneRay ray = to_world(view, *trace_pixel(lens, nullptr, u, v));
    const auto hit = scene.first_hit(ray.start, ray.direction);
    if (!hit) return;
    SparsePoint& point = points[i];
    point.position = ray.start + hit->distance * ray.direction;
    point.color = shader({point.position, *hit, hit->distance / lens.focal});
    for (const std::size_t k : tested[i / (rows * columns)])
      if (const auto pixel = observe(scene, lens, views[k], point.position))
        point.observations.push_back({k, *pixel});
  });
  std::erase_if(points, [](const SparsePoint& p) { return p.observations.size() < 2; });
  return points;
}

}  // namespace axial::simulate
