// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/cloud_evaluation.h"

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "evaluate/sampling.h"

namespace axial::evaluate {
namespace {

constexpr std::size_t kMostDraws = 20;  // times the samples asked for

// What nanoflann asks of a point set.
struct PointSet {
  std::span<const Eigen::Vector3f> points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

void check(const CloudOptions& options) {
  if (options.tolerances.empty()) fail("no tolerance is given");
  for (const double tolerance : options.tolerances)
    if (!(tolerance > 0) || !std::isfinite(tolerance))
      fail("tolerance is {}: it must be a positive length in metres", tolerance);
  if (options.samples == 0) fail("the number of samples is 0");
}

void check(std::span<const Eigen::Vector3f> points) {
  if (points.empty()) fail("the cloud has no points");
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite()) fail("point {} of the cloud is not finite", i);
}

struct Samples {
  std::vector<Eigen::Vector3f> counted;
  std::size_t drawn = 0;
};

Samples draw_samples(const Mesh& truth, const Surface& surface, std::span<const View> views,
                     const CloudOptions& options) {
  Samples result{sample_surface(truth, options.samples, options.seed), options.samples};
  if (views.empty()) return result;
  result.counted = seen_points(result.counted, views, surface, options.least_views);
  // A truth that reaches far beyond the pictures needs more samples for as many that count.
  const std::size_t factor =
      std::min(kMostDraws, options.samples / std::max<std::size_t>(result.counted.size(), 1));
  if (factor > 1) {
    result.drawn = factor * options.samples;
    result.counted = seen_points(sample_surface(truth, result.drawn, options.seed), views, surface,
                                 options.least_views);
  }
  if (result.counted.empty())
    fail("no sample of the truth is seen by {} of the {} views", options.least_views, views.size());
  return result;
}

CloudEvaluation summed_up(std::vector<float> to_truth, std::span<const float> to_reconstruction,
                          std::size_t drawn, std::span<const View> views,
                          const CloudOptions& options) {
  CloudEvaluation result;
  const double upper = 4 * options.tolerances.front();
  result.accuracy = summarise(to_truth);
  result.completeness = summarise(to_reconstruction);
  result.accuracy_histogram = histogram(to_truth, upper, options.histogram_bins);
  result.completeness_histogram = histogram(to_reconstruction, upper, options.histogram_bins);
  for (const double tolerance : options.tolerances)
    result.scores.push_back(score(to_truth, to_reconstruction, tolerance));
  result.samples = drawn;
  result.counted_samples = to_reconstruction.size();
  result.views = views.size();
  result.distances = std::move(to_truth);
  return result;
}

}  // namespace

std::vector<float> nearest_point_distances(std::span<const Eigen::Vector3f> queries,
                                           std::span<const Eigen::Vector3f> points) {
  using Distance = nanoflann::L2_Simple_Adaptor<float, PointSet, double>;
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<Distance, PointSet, 3, std::uint32_t>;
  const PointSet set{points};
  const Tree tree(3, set, nanoflann::KDTreeSingleIndexAdaptorParams(16));
  std::vector<float> distances(queries.size());
  parallel_for(
      queries.size(),
      [&](std::size_t i) {
        std::uint32_t index = 0;
        double distance2 = 0;
        tree.knnSearch(queries[i].data(), 1, &index, &distance2);
        distances[i] = static_cast<float>(std::sqrt(distance2));
      },
      1024);
  return distances;
}

CloudEvaluation evaluate_cloud(std::span<const Eigen::Vector3f> points, const Mesh& truth,
                               const Surface& surface, std::span<const View> views,
                               const CloudOptions& options) {
  check(options);
  check(points);
  const Samples samples = draw_samples(truth, surface, views, options);
  return summed_up(distances_to(surface, points), nearest_point_distances(samples.counted, points),
                   samples.drawn, views, options);
}

CloudEvaluation evaluate_mesh(const Mesh& mesh, const Mesh& truth, const Surface& surface,
                              std::span<const View> views, const CloudOptions& options,
                              std::vector<Eigen::Vector3f>& sampled) {
  check(options);
  // Another seed than the truth's: the same mesh twice must not meet itself in the same points.
  sampled = sample_surface(mesh, options.samples, options.seed + 1);
  const Samples samples = draw_samples(truth, surface, views, options);
  return summed_up(distances_to(surface, sampled), distances_to(Surface(mesh), samples.counted),
                   samples.drawn, views, options);
}

}  // namespace axial::evaluate
