// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the source views of every image, from the sparse points that images share. Angles and
// scales are computed with each camera's refracted rays.
#pragma once

#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "base/progress.h"
#include "scene/scene.h"

namespace axial {

struct ViewSelectionOptions {
  double optimal_angle = 12.0 * std::numbers::pi / 180.0;  // best triangulation angle [rad]
  std::uint32_t min_shared_points = 3;                     // with fewer, an image is no candidate
  std::size_t min_trusted_views = 2;   // images that must see a sparse point to trust it
  std::size_t min_init_points = 4;     // with fewer trusted points, the image is unusable
  std::size_t min_views = 2;           // with fewer candidates, the image is unusable; at most the
                                       // number of other calibrated images
  double weight_outside_region = 0.7;  // of points outside Scene::region

  // For filter_neighbours(). The fields of ViewScore explain the quantities.
  double min_area = 0.05;
  double min_scale = 0.2, max_scale = 3.2;
  double min_angle = 3.0 * std::numbers::pi / 180.0;
  double max_angle = 65.0 * std::numbers::pi / 180.0;
  std::size_t max_views = 12;

  // For choose_source_views().
  double min_score = 2.0;
  double min_score_ratio = 0.03;  // relative to the best score
};

// Results for one image from the sparse cloud, besides its neighbours.
struct ViewPreparation {
  // Indices into Scene::points of the trusted points that the image sees, in ascending order.
  std::vector<std::uint32_t> init_points;
  // Range of depths (lambda, see DepthMap) to search [m]: from 0.9 times the smallest to 1.1 times
  // the largest depth of init_points. 0 and 0 without init_points.
  float min_depth = 0, max_depth = 0;
  std::string problem;  // the reason why the image cannot be a reference view; empty: it can
  bool usable() const { return problem.empty(); }
};

// Scores the neighbours of all images. For every calibrated image it fills from scene.points
//   - neighbours: unfiltered, by decreasing score, images of equal score by index,
//   - min_depth, average_depth and max_depth: z-depth over all points that the image sees.
// Returns one ViewPreparation per image.
//
// The score of a pair of images is the sum of the weights of its shared points times the covered
// fraction of the image (at least 0.01). A point's weight depends on the angle between its two rays
// in the medium, on the ratio of its two footprints and on the region. The footprint [px/m] is the
// smaller singular value of the projection's Jacobian, with its rows scaled to the focal length fx;
// for a pinhole it is fx / z.
//
// Ignored are observations that the camera cannot have made (points behind it or outside the port's
// field), points that are not finite, and uncalibrated images. A repeated observation counts once.
// The time is linear in the number of pairs of observations of a point. Throws an Error for views
// of images that do not exist.
std::vector<ViewPreparation> score_neighbours(Scene& scene,
                                              const ViewSelectionOptions& options = {},
                                              const ProgressSink& progress = {});

// The counts on which the memory of score_neighbours() depends.
struct ScoringSize {
  std::uint64_t images = 0, points = 0, observations = 0;
  std::uint64_t neighbours = 0;  // entries in the lists of all images
};
struct ScoringMemory {
  std::uint64_t work = 0;  // [bytes], freed at the end
  std::uint64_t kept = 0;  // [bytes], the lists of neighbours and of points
};
// An upper bound of the memory that score_neighbours() uses, with the present number of threads.
ScoringMemory scoring_memory(const ScoringSize& size);

// The counts of `scene`; `neighbours` is the bound of most_neighbours().
ScoringSize scoring_size(const Scene& scene, const ViewSelectionOptions& options = {});

// An upper bound of the number of neighbours of all images. `pairs`: the number of ordered pairs of
// views of a point, summed over all points.
std::uint64_t most_neighbours(std::uint64_t images, std::uint64_t pairs,
                              const ViewSelectionOptions& options = {});

// A closer upper bound: the number of neighbours of all images if each camera can have made all its
// observations. Needs less time and memory than scoring. Throws an Error for views of images that
// do not exist.
std::uint64_t count_neighbours(const Scene& scene, const ViewSelectionOptions& options = {});

// The working list of an image. Starting with the worst, removes neighbours whose area is too small
// or whose scale or angle is out of range, as long as more than max(4, 3/4 max_views) neighbours
// remain. Then keeps the best max_views. `neighbours`: by decreasing score.
std::vector<ViewScore> filter_neighbours(const std::vector<ViewScore>& neighbours,
                                         const ViewSelectionOptions& options = {});

// The first `number_views` (0: all) neighbours of a working list whose score is at least
// max(min_score, min_score_ratio * best score). Empty if there is none.
std::vector<ViewScore> choose_source_views(const std::vector<ViewScore>& filtered,
                                           std::size_t number_views,
                                           const ViewSelectionOptions& options = {});

// For a message: the reasons why choose_source_views() found no view among an image's neighbours.
std::string why_no_source_view(const std::vector<ViewScore>& neighbours,
                               const ViewSelectionOptions& options = {});

}  // namespace axial
