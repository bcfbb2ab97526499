// SPDX-License-Identifier: GPL-3.0-or-later
// A cloud or a mesh against the true mesh: accuracy, completeness, F-score.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "evaluate/places.h"
#include "evaluate/statistics.h"
#include "evaluate/surface.h"
#include "evaluate/views.h"
#include "scene/mesh.h"

namespace axial::evaluate {

struct CloudOptions {
  std::vector<double> tolerances{0.005};  // [m]; the first one scales histograms and colours
  std::size_t samples = 200000;           // of the true mesh, for completeness; see below
  std::uint64_t seed = 1;
  std::uint32_t least_views = 2;  // that must see a sample for it to count
  std::size_t histogram_bins = 80;
  double gross = 0;  // distance beyond which an error is gross [m]; 0: 4 * first tolerance
};

struct CloudEvaluation {
  std::vector<float> distances;     // of every point to the truth, in the points' order
  DistanceStatistics accuracy;      // of `distances`
  DistanceStatistics completeness;  // of every counted sample of the truth to the reconstruction
  Histogram accuracy_histogram, completeness_histogram;  // over 0 .. 4 * first tolerance
  std::vector<Score> scores;                             // one a tolerance
  Places places;                                         // the samples of the truth that count
  std::vector<float> place_distances;                    // of each to the reconstruction
  std::vector<RecallOfViews> by_views;                   // empty without cameras
  double gross = 0, gross_share = 0;                     // of the points: beyond so many metres
  std::size_t views = 0;  // 0: no cameras were given, all samples count
};

// Accuracy: exact distance of every point to `truth`. Completeness: distance of samples of `truth`,
// uniform by area, to the nearest point; only samples that `least_views` of `views` see, or all if
// there are no views. If few of `options.samples` are seen, up to 20 times as many are drawn, so
// that about `options.samples` count. `surface` is the one of `truth`. Error for no points, a point
// that is not finite, no or a bad tolerance, no samples, or no sample that is seen.
CloudEvaluation evaluate_cloud(std::span<const Eigen::Vector3f> points, const Mesh& truth,
                               const Surface& surface, std::span<const View> views,
                               const CloudOptions& options);

// The same for a mesh: accuracy of `options.samples` samples of it, uniform by area, which are
// returned in `sampled`; completeness by exact distance of the truth's samples to its triangles.
CloudEvaluation evaluate_mesh(const Mesh& mesh, const Mesh& truth, const Surface& surface,
                              std::span<const View> views, const CloudOptions& options,
                              std::vector<Eigen::Vector3f>& sampled);

// Distance of every query to the nearest of `points` (at least one).
std::vector<float> nearest_point_distances(std::span<const Eigen::Vector3f> queries,
                                           std::span<const Eigen::Vector3f> points);

}  // namespace axial::evaluate
