// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/mesh_evaluation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/order_statistics.h"
#include "base/parallel.h"
#include "geometry/faces.h"

namespace axial::evaluate {
namespace {

constexpr float kNoAngle = -1;  // a face without area has no normal

// The nearest point of the truth to each sample, and the angle between the normals there [degrees].
struct Nearest {
  std::vector<Eigen::Vector3f> places;
  std::vector<float> angles;
};

Nearest nearest_of(const Mesh& mesh, const MeshSamples& samples, const geometry::Surface& truth) {
  Nearest nearest{std::vector<Eigen::Vector3f>(samples.positions.size()),
                  std::vector<float>(samples.positions.size(), kNoAngle)};
  parallel_for(
      samples.positions.size(),
      [&](std::size_t i) {
        const geometry::ClosestPoint closest = truth.closest(samples.positions[i].cast<double>());
        nearest.places[i] = closest.point.cast<float>();
        const Eigen::Vector3d n = geometry::area_vector(mesh, samples.faces[i]);
        const Eigen::Vector3d true_n = truth.face_normal(closest.face);
        if (n.isZero(0) || true_n.isZero(0)) return;
        const double angle = std::atan2(n.cross(true_n).norm(), n.dot(true_n));
        nearest.angles[i] = static_cast<float>(angle * 180 / std::numbers::pi);
      },
      kPointGrain);
  return nearest;
}

NormalErrors normal_errors(std::vector<float> angles) {
  std::erase(angles, kNoAngle);
  NormalErrors errors;
  errors.count = angles.size();
  if (angles.empty()) return errors;
  for (std::size_t k = 0; k < kNormalLimits.size(); ++k)
    errors.within[k] =
        static_cast<double>(std::ranges::count_if(
            angles, [&](float angle) { return static_cast<double>(angle) <= kNormalLimits[k]; })) /
        static_cast<double>(angles.size());
  errors.median = mean_median(std::move(angles));
  return errors;
}

SeenPart seen_part(const std::vector<std::uint32_t>& counts, const Nearest& nearest,
                   const CloudOptions& options, const CloudEvaluation& whole) {
  std::vector<float> distances, angles;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] < options.least_views) continue;
    distances.push_back(whole.distances[i]);
    angles.push_back(nearest.angles[i]);
  }
  SeenPart seen;
  seen.share = static_cast<double>(distances.size()) / static_cast<double>(counts.size());
  seen.accuracy = summarise(distances);
  for (const double tolerance : options.tolerances)
    seen.scores.push_back(score(distances, whole.place_distances, tolerance));
  seen.normals = normal_errors(std::move(angles));
  return seen;
}

UnseenArea unseen_area(const std::vector<std::uint32_t>& counts, const CloudOptions& options,
                       const CloudEvaluation& whole) {
  std::size_t no_view = 0, few_views = 0, far = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0)
      ++no_view;
    else if (counts[i] < options.least_views)
      ++few_views;
    else if (static_cast<double>(whole.distances[i]) > whole.gross)
      ++far;
  }
  const auto share = [&](std::size_t n) {
    return static_cast<double>(n) / static_cast<double>(counts.size());
  };
  return {share(no_view), share(few_views), share(far)};
}

}  // namespace

MeshEvaluation evaluate_mesh_parts(const Mesh& mesh, const MeshSamples& samples,
                                   const geometry::Surface& truth, std::span<const View> views,
                                   const CloudOptions& options, const CloudEvaluation& whole) {
  MeshEvaluation result;
  const Nearest nearest = nearest_of(mesh, samples, truth);
  result.normals = normal_errors(nearest.angles);
  if (!views.empty()) {
    const std::vector<std::uint32_t> counts = count_views(nearest.places, views, truth);
    result.seen = seen_part(counts, nearest, options, whole);
    result.unseen = unseen_area(counts, options, whole);
  }
  result.topology = topology_of(mesh);
  return result;
}

}  // namespace axial::evaluate
