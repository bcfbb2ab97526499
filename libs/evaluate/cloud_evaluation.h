// SPDX-License-Identifier: GPL-3.0-or-later
// Compares a cloud or a mesh with the true mesh: accuracy, completeness, F-score. A reconstruction
// is the cloud or the mesh that is evaluated. The truth is the true mesh. Both are in one frame, in
// metres. Counted samples are random points of the truth that enough views see.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "evaluate/places.h"
#include "evaluate/statistics.h"
#include "evaluate/views.h"
#include "geometry/surface.h"
#include "scene/mesh.h"

namespace axial::evaluate {

struct CloudOptions {
  // Distances that count as near in the scores [m]. The histograms end at 4 times the first one.
  std::vector<double> tolerances{0.005};
  // Wanted number of counted samples of the truth, and number of samples of an evaluated mesh.
  std::size_t samples = 200000;
  std::uint64_t seed = 1;         // of the samples
  std::uint32_t least_views = 2;  // a sample counts if at least this number of views see it
  std::size_t histogram_bins = 80;
  double gross = 0;  // larger distances are gross errors [m]; 0: 4 times the first tolerance
};

// The results. All distances are unsigned and in metres.
struct CloudEvaluation {
  // From every point of the cloud, or every sample of the mesh, to the truth, in their order.
  std::vector<float> distances;
  DistanceStatistics accuracy;      // of `distances`
  DistanceStatistics completeness;  // of `place_distances`
  // Histograms of `distances` and of `place_distances`, from 0 to 4 times the first tolerance.
  Histogram accuracy_histogram, completeness_histogram;
  std::vector<Score> scores;            // one for each tolerance, in their order
  Places places;                        // the counted samples of the truth
  std::vector<float> place_distances;   // from each of `places` to the reconstruction
  std::vector<RecallOfViews> by_views;  // recall_by_views() of `places`; empty without views
  double gross = 0, gross_share = 0;    // limit [m]; share of `distances` that are larger
  std::size_t views = 0;                // number of views; 0: all samples count
};

// Evaluates the cloud `points`. Accuracy is the exact distance from every point to `truth`.
// Completeness is the distance from every counted sample of `truth` to the nearest point. Samples
// are uniform by area. A sample counts if at least `options.least_views` of `views` see it. Without
// views, all samples count. The samples are drawn by draw_places() (places.h), which repeats the
// draw with more samples if few count. Precondition: `surface` is made from `truth`. Error if there
// are no points, a point is not finite, there is no tolerance, a tolerance is not positive and
// finite, `options.samples` is 0, the area of `truth` is 0 or not finite, or no sample counts.
CloudEvaluation evaluate_cloud(std::span<const Eigen::Vector3f> points, const Mesh& truth,
                               const geometry::Surface& surface, std::span<const View> views,
                               const CloudOptions& options);

// Evaluates a mesh. Accuracy is the exact distance from `options.samples` samples of `mesh` to
// `truth`. The samples are uniform by area. `sampled` receives the samples, and `faces`, unless
// null, receives the face of `mesh` on which each sample lies. Both are in the order of
// CloudEvaluation::distances. Completeness is the exact distance from every counted sample of
// `truth` to the triangles of `mesh`. Counted samples, `surface`, `views` and the errors of
// `options` and `truth` are as for evaluate_cloud(). Error, too, if the area of `mesh` is 0 or not
// finite, a face index is out of range or a coordinate is not finite.
CloudEvaluation evaluate_mesh(const Mesh& mesh, const Mesh& truth, const geometry::Surface& surface,
                              std::span<const View> views, const CloudOptions& options,
                              std::vector<Eigen::Vector3f>& sampled,
                              std::vector<std::uint32_t>* faces = nullptr);

// Returns the distance from every query to the nearest of `points`, in the order and the unit of
// the queries. Precondition: there is at least one point.
std::vector<float> nearest_point_distances(std::span<const Eigen::Vector3f> queries,
                                           std::span<const Eigen::Vector3f> points);

}  // namespace axial::evaluate
