// SPDX-License-Identifier: GPL-3.0-or-later
// Compares a cloud or a mesh with the true mesh: accuracy, completeness, F-score.
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
  std::vector<double> tolerances{0.005};  // [m]; the first scales histograms and colours
  std::size_t samples = 200000;           // samples of the true mesh for completeness, see below
  std::uint64_t seed = 1;
  std::uint32_t least_views = 2;  // number of views that must see a sample for it to count
  std::size_t histogram_bins = 80;
  double gross = 0;  // distance beyond which an error is gross [m]; 0: 4 * first tolerance
};

struct CloudEvaluation {
  std::vector<float> distances;     // from every point to the truth, in the points' order
  DistanceStatistics accuracy;      // of `distances`
  DistanceStatistics completeness;  // from the counted samples of the truth
  Histogram accuracy_histogram, completeness_histogram;  // from 0 to 4 * first tolerance
  std::vector<Score> scores;                             // one for each tolerance
  Places places;                                         // the counted samples of the truth
  std::vector<float> place_distances;                    // from each of these to the reconstruction
  std::vector<RecallOfViews> by_views;                   // empty without cameras
  double gross = 0, gross_share = 0;                     // limit [m]; share of points beyond it
  std::size_t views = 0;  // 0: no cameras are known, all samples count
};

// Evaluates a cloud. Accuracy is the exact distance from every point to `truth`. Completeness is
// the distance from samples of `truth`, uniform by area, to the nearest point. A sample counts if
// at least `least_views` of `views` see it, or always if there are no views. If few of
// `options.samples` samples are seen, up to 20 times as many are drawn, so that about
// `options.samples` count. `surface` must be made from `truth`. Error for no points, a point that
// is not finite, no tolerance or a tolerance that is not positive, no samples, or no sample that is
// seen.
CloudEvaluation evaluate_cloud(std::span<const Eigen::Vector3f> points, const Mesh& truth,
                               const Surface& surface, std::span<const View> views,
                               const CloudOptions& options);

// Evaluates a mesh. Accuracy is that of `options.samples` samples of the mesh, uniform by area,
// which are returned in `sampled`; `faces`, unless null, receives their faces. Completeness is the
// exact distance from the samples of the truth to the triangles of the mesh. Errors as for
// evaluate_cloud.
CloudEvaluation evaluate_mesh(const Mesh& mesh, const Mesh& truth, const Surface& surface,
                              std::span<const View> views, const CloudOptions& options,
                              std::vector<Eigen::Vector3f>& sampled,
                              std::vector<std::uint32_t>* faces = nullptr);

// Returns the distance of every query to the nearest of `points`, of which there must be at least
// one.
std::vector<float> nearest_point_distances(std::span<const Eigen::Vector3f> queries,
                                           std::span<const Eigen::Vector3f> points);

}  // namespace axial::evaluate
