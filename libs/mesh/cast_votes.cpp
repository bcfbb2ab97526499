// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cast_votes.h"

#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "mesh/facet_quality.h"
#include "mesh/weak_support.h"

namespace axial::mesh {
namespace {

// The tetrahedron that contains a camera is certainly outside.
constexpr double kCertain = 1e5;

// The sum stops at the limit. It is the same for any order of threads, because no weight is
// negative.
void add(std::int32_t& sum, double weight) {
  const double scaled = std::min(weight * kVoteScale, static_cast<double>(kLargestVote));
  const auto votes = static_cast<std::int32_t>(std::lround(scaled));
  if (votes == 0) return;
  std::atomic_ref<std::int32_t> shared(sum);
  std::int32_t before = shared.load(std::memory_order_relaxed);
  while (!shared.compare_exchange_weak(before, std::min(before + votes, kLargestVote),
                                       std::memory_order_relaxed)) {
  }
}

struct Ray {
  std::uint32_t start = 0;  // a point
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  double length = 0;  // to the exit point [m]
  double weight = 0, sigma = 0;

  // The cost of a surface that the ray crosses `distance` in front of its point.
  double cost(double distance) const {
    if (distance > 4 * sigma) return weight;  // the difference is below a vote's resolution
    return weight * (1 - std::exp(-0.5 * distance * distance / (sigma * sigma)));
  }
};

void cast(const Tetrahedra& tetrahedra, std::span<const Eigen::Vector3f> positions,
          const Stars& stars, const Ray& ray, Votes& votes) {
  const std::uint32_t last =
      walk(tetrahedra, positions, stars, ray.start, ray.direction, ray.length,
           [&](const Crossing& crossing) {
             add(votes.facets[crossing.to][static_cast<std::size_t>(crossing.back)],
                 ray.cost(crossing.distance));
           });
  if (last != Tetrahedra::kInfinity) add(votes.outside[last], kCertain);
  const std::uint32_t behind =
      walk(tetrahedra, positions, stars, ray.start, -ray.direction, ray.sigma,
           [&](const Crossing& crossing) {
             add(votes.facets[crossing.from][static_cast<std::size_t>(crossing.facet)],
                 ray.cost(crossing.distance));
           });
  if (behind != Tetrahedra::kInfinity) add(votes.inside[behind], ray.weight);
}

// Calls use(ray) for each view of point i that sees it.
template <class Use>
void for_each_ray(const MergedPoints& points, std::size_t i, const ViewRays& rays,
                  const VoteOptions& options, Use&& use) {
  const Eigen::Vector3d at = points.positions[i].cast<double>();
  for (std::size_t v = points.view_begin[i]; v < points.view_begin[i + 1]; ++v) {
    const auto exit = rays.exit_point(points.view_images[v], at);
    if (!exit) continue;
    const double length = (*exit - at).norm();
    if (!(length > 0)) continue;
    use(Ray{static_cast<std::uint32_t>(i), (*exit - at) / length, length,
            options.constant_weight ? 1 : static_cast<double>(points.view_weights[v]),
            expected_error(points, i, options)});
  }
}

// Calls work(i) for all i in parallel and reports progress after each part.
void in_parts(std::size_t count, const ProgressSink& progress,
              const std::function<void(std::size_t)>& work) {
  constexpr std::size_t kPart = 1 << 16;
  for (std::size_t begin = 0; begin < count; begin += kPart) {
    const std::size_t part = std::min(kPart, count - begin);
    parallel_for(
        part, [&](std::size_t i) { work(begin + i); }, kPointGrain);
    if (progress) progress(begin + part, count);
  }
}

}  // namespace

double expected_error(const MergedPoints& points, std::size_t i, const VoteOptions& options) {
  constexpr double kPixels = 2.5;
  return kPixels * options.thickness_factor * static_cast<double>(points.pixel_widths[i]);
}

Votes cast_votes(const Tetrahedra& tetrahedra, const MergedPoints& points, const ViewRays& rays,
                 const VoteOptions& options, const Context& context) {
  Votes votes;
  votes.outside.assign(tetrahedra.size(), 0);
  votes.inside.assign(tetrahedra.size(), 0);
  votes.facets.assign(tetrahedra.size(), {0, 0, 0, 0});
  const Stars stars = stars_of(tetrahedra, points.size());
  in_parts(points.size(), context.stage("Voted"), [&](std::size_t i) {
    if (stars.of(i).empty()) return;
    for_each_ray(points, i, rays, options,
                 [&](const Ray& ray) { cast(tetrahedra, points.positions, stars, ray, votes); });
  });
  if (options.weak_support) {
    const WeakSupport weak(tetrahedra, points.positions, stars, votes);
    std::vector<std::int32_t> more(tetrahedra.size(), 0);
    in_parts(points.size(), {}, [&](std::size_t i) {
      if (stars.of(i).empty()) return;
      for_each_ray(points, i, rays, options, [&](const Ray& ray) {
        const auto [cell, gain] = weak.gain(ray.start, ray.direction, ray.sigma);
        if (gain > 0) add(more[cell], gain * ray.weight);
      });
    });
    parallel_for(
        more.size(), [&](std::size_t c) { add(votes.inside[c], double(more[c]) / kVoteScale); },
        kPointGrain);
  }
  parallel_for(
      tetrahedra.size(),
      [&](std::size_t cell) {
        for (std::size_t i = 0; i < 4; ++i)
          add(votes.facets[cell][i],
              options.quality_factor * shape_cost(tetrahedra, points.positions, cell, i));
      },
      kPointGrain);
  return votes;
}

}  // namespace axial::mesh
