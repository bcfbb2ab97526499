// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the source views of every image, from the sparse points that images share. Angles and
// scales are computed with each camera's refracted rays.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "axial/scene_options.h"
#include "base/progress.h"

namespace axial {

// The result of score_neighbours() for one image, besides the neighbours, which score_neighbours()
// stores in SceneImage.
struct ViewPreparation {
  // Indices into Scene::points of the trusted points that the image sees, in ascending order.
  std::vector<std::uint32_t> init_points;
  // Range of depths (lambda, see DepthMap) to search [m]: from 0.9 times the smallest to 1.1
  // times the largest depth of init_points. Both are 0 without init_points.
  float min_depth = 0, max_depth = 0;
  std::string problem;  // the reason why the image cannot be a reference view; empty: it can
  bool usable() const { return problem.empty(); }  // whether the image can be a reference view
};

// Scores the neighbours of all images. For every calibrated image, the function computes these
// values from scene.points and stores them in SceneImage:
// - neighbours: unfiltered, by decreasing score, images of equal score by index.
// - min_depth, average_depth and max_depth: z-depth over all points that the image sees; 0 if it
//   sees none.
//
// Images without enough trusted points (min_init_points) or candidates (min_views) get a problem.
// Returns one ViewPreparation per image, in the order of Scene::images. Calls progress(done, total)
// with numbers of images, from any thread but one call at a time. Throws an Error if a point has a
// view of an image that does not exist.
//
// The score of the neighbour B of an image A is the sum of the weights of their shared points,
// times max(area, 0.01). The weight of a point is the product of three factors:
// - Angle: a function of the angle between the two rays of the point in the scene medium. It is 1
//   at `optimal_angle`, falls on both sides like a normal distribution, and is at least 0.1.
// - Scale: let r be the footprint of the point in A divided by its footprint in B. The factor is
//   r^2 for r < 1, 1 for r from 1 to 1.6, and (1.6 / r)^2 above.
// - Region: 1 inside Scene::region or without a region, `weight_outside_region` outside.
//
// The area is a fraction of image A. A is divided into a grid of 16 x 16 equal cells. The area is
// the share of cells that contain the image in A of at least one shared point. Only points whose
// images lie inside both A and B count for the area.
//
// The footprint [px/m] of a point in an image is the smaller singular value of the Jacobian of
// the projection, after its second row is multiplied by fx / fy. For a pinhole it is fx / z.
//
// The function ignores uncalibrated images, points that are not finite, and observations that the
// camera cannot have made (points behind the camera or outside the port's field). A repeated
// observation counts once. Let n be the number of views of a point. The time grows with the sum
// of n^2 over all points and with the number of images.
std::vector<ViewPreparation> score_neighbours(Scene& scene,
                                              const ViewSelectionOptions& options = {},
                                              const ProgressSink& progress = {});

// The counts on which the memory of score_neighbours() depends.
struct ScoringSize {
  std::uint64_t images = 0, points = 0, observations = 0;
  std::uint64_t neighbours = 0;  // entries in SceneImage::neighbours of all images together
};
// An upper bound of memory.
struct ScoringMemory {
  std::uint64_t work = 0;  // [bytes], freed at the end
  std::uint64_t kept = 0;  // [bytes], the lists of neighbours and of points
};
// An upper bound of the memory that score_neighbours() uses with the present number of threads.
ScoringMemory scoring_memory(const ScoringSize& size);

// The counts of `scene`; `neighbours` is the bound of most_neighbours().
ScoringSize scoring_size(const Scene& scene, const ViewSelectionOptions& options = {});

// An upper bound of the total number of neighbours of all images. `pairs`: the number of ordered
// pairs of different views of one point, summed over all points.
std::uint64_t most_neighbours(std::uint64_t images, std::uint64_t pairs,
                              const ViewSelectionOptions& options = {});

// A closer upper bound of the total number of neighbours of all images. It is the exact number if
// score_neighbours() ignores no observation. The function needs less time and memory than
// score_neighbours(). Throws an Error if a point has a view of an image that does not exist.
std::uint64_t count_neighbours(const Scene& scene, const ViewSelectionOptions& options = {});

// Returns the working list of an image: the neighbours from which choose_source_views() chooses, by
// decreasing score. `neighbours`: sorted by decreasing score. First removes unsuitable neighbours,
// the worst score first, while more than max(4, 3/4 max_views) neighbours remain. A neighbour is
// unsuitable if its area is below `min_area`, its scale is outside [min_scale, max_scale] or its
// angle is outside [min_angle, max_angle]. Then keeps the `max_views` best of the remaining
// neighbours.
std::vector<ViewScore> filter_neighbours(const std::vector<ViewScore>& neighbours,
                                         const ViewSelectionOptions& options = {});

// Chooses source views from a working list, which is sorted by decreasing score. Let s be the
// larger of `min_score` and `min_score_ratio` times the best score. Returns the first
// `number_views` neighbours with a score of at least s, or all of them if `number_views` is 0.
// Empty if there is no such neighbour.
std::vector<ViewScore> choose_source_views(const std::vector<ViewScore>& filtered,
                                           std::size_t number_views,
                                           const ViewSelectionOptions& options = {});

// Returns, as words for a message, the reasons why choose_source_views() found no view among the
// neighbours of an image, and to how many neighbours each reason applies. `neighbours`: all
// neighbours of the image, before filter_neighbours().
std::string why_no_source_view(const std::vector<ViewScore>& neighbours,
                               const ViewSelectionOptions& options = {});

}  // namespace axial
