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
  std::size_t samples = 200000;           // wanted number of counted samples of the true mesh
  std::uint64_t seed = 1;
  std::uint32_t least_views = 2;  // a sample counts if at least this number of views see it
  std::size_t histogram_bins = 80;
  double gross = 0;  // larger distances are gross errors [m]; 0: 4 * first tolerance
};

struct CloudEvaluation {
  std::vector<float> distances;     // from every point to the truth, in the points' order
  DistanceStatistics accuracy;      // of `distances`
  DistanceStatistics completeness;  // from the counted samples of the truth
  Histogram accuracy_histogram, completeness_histogram;  // from 0 to 4 * first tolerance
  std::vector<Score> scores;                             // one for each tolerance
  Places places;                                         // the counted samples of the truth
  std::vector<float> place_distances;                    // from each place to the reconstruction
  std::vector<RecallOfViews> by_views;                   // empty without cameras
  double gross = 0, gross_share = 0;  // limit [m]; share of points with larger distances
  std::size_t views = 0;              // number of views; 0: no cameras are known, all samples count
};

// Evaluates a cloud. Accuracy is the exact distance from every point to `truth`. Completeness is
// the distance from every counted sample of `truth` to the nearest point. Samples are uniform by
// area. A sample counts if at least `options.least_views` of `views` see it. Without views, all
// samples count. The samples are drawn by draw_places() (places.h), which repeats the draw with
// more samples if few count. Precondition: `surface` is made from `truth`. Error if there are no
// points, a point is not finite, there is no tolerance, a tolerance is not positive and finite,
// `options.samples` is 0, or no sample counts.
CloudEvaluation evaluate_cloud(std::span<const Eigen::Vector3f> points, const Mesh& truth,
                               const Surface& surface, std::span<const View> views,
                               const CloudOptions& options);

// Evaluates a mesh. Accuracy is the exact distance from `options.samples` samples of `mesh` to
// `truth`. The samples are uniform by area. `sampled` receives the samples. `faces`, unless null,
// receives the face of `mesh` on which each sample lies. Completeness is the exact distance from
// every counted sample of `truth` to the triangles of `mesh`. Errors of `options` and of the
// counted samples as for evaluate_cloud. Errors of `mesh` as for sample_surface (sampling.h) and
// Surface (surface.h).
CloudEvaluation evaluate_mesh(const Mesh& mesh, const Mesh& truth, const Surface& surface,
                              std::span<const View> views, const CloudOptions& options,
                              std::vector<Eigen::Vector3f>& sampled,
                              std::vector<std::uint32_t>* faces = nullptr);

// Returns the distance from every query to the nearest of `points`, in the order of the queries.
// Precondition: there is at least one point.
std::vector<float> nearest_point_distances(std::span<const Eigen::Vector3f> queries,
                                           std::span<const Eigen::Vector3f> points);

}  // namespace axial::evaluate
