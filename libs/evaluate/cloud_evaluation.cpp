// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/cloud_evaluation.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "geometry/point_tree.h"
#include "geometry/sampling.h"

namespace axial::evaluate {
namespace {

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

Places draw_places(const Mesh& truth, const geometry::Surface& surface, std::span<const View> views,
                   const CloudOptions& options) {
  return draw_places(truth, surface, views, {options.samples, options.seed, options.least_views});
}

double share_beyond(std::span<const float> distances, double limit) {
  const auto beyond = std::ranges::count_if(
      distances, [&](float distance) { return static_cast<double>(distance) > limit; });
  return static_cast<double>(beyond) / static_cast<double>(distances.size());
}

CloudEvaluation summed_up(std::vector<float> to_truth, std::vector<float> to_reconstruction,
                          Places places, std::span<const View> views, const CloudOptions& options) {
  CloudEvaluation result;
  const double upper = 4 * options.tolerances.front();
  result.accuracy = summarise(to_truth);
  result.completeness = summarise(to_reconstruction);
  result.accuracy_histogram = histogram(to_truth, upper, options.histogram_bins);
  result.completeness_histogram = histogram(to_reconstruction, upper, options.histogram_bins);
  for (const double tolerance : options.tolerances)
    result.scores.push_back(score(to_truth, to_reconstruction, tolerance));
  if (!views.empty())
    result.by_views =
        recall_by_views(places, to_reconstruction, options.tolerances, options.least_views);
  result.gross = options.gross > 0 ? options.gross : upper;
  result.gross_share = share_beyond(to_truth, result.gross);
  result.places = std::move(places);
  result.place_distances = std::move(to_reconstruction);
  result.views = views.size();
  result.distances = std::move(to_truth);
  return result;
}

}  // namespace

std::vector<float> nearest_point_distances(std::span<const Eigen::Vector3f> queries,
                                           std::span<const Eigen::Vector3f> points) {
  const geometry::PointSet set{points};
  const geometry::PointTree<double> tree(3, set, {16});
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
                               const geometry::Surface& surface, std::span<const View> views,
                               const CloudOptions& options) {
  check(options);
  check(points);
  Places places = draw_places(truth, surface, views, options);
  std::vector<float> found = nearest_point_distances(places.positions, points);
  return summed_up(geometry::distances_to(surface, points), std::move(found), std::move(places),
                   views, options);
}

CloudEvaluation evaluate_mesh(const Mesh& mesh, const Mesh& truth, const geometry::Surface& surface,
                              std::span<const View> views, const CloudOptions& options,
                              std::vector<Eigen::Vector3f>& sampled,
                              std::vector<std::uint32_t>* faces) {
  check(options);
  // The seed differs from that of the truth, so that a mesh that is compared with itself is not
  // sampled at the same points.
  sampled = geometry::sample_surface(mesh, options.samples, options.seed + 1, faces);
  Places places = draw_places(truth, surface, views, options);
  std::vector<float> found = geometry::distances_to(geometry::Surface(mesh), places.positions);
  return summed_up(geometry::distances_to(surface, sampled), std::move(found), std::move(places),
                   views, options);
}

}  // namespace axial::evaluate
