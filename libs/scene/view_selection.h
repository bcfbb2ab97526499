// SPDX-License-Identifier: GPL-3.0-or-later
// Which images suit as source views of which (OPENMVS_FACTS 6.1), with every camera's own rays.
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
  std::uint32_t min_shared_points = 3;                     // fewer: no candidate at all
  std::size_t min_trusted_views = 2;  // views that make a sparse point an init point
  std::size_t min_init_points = 4;    // fewer: the image is unusable
  std::size_t min_views = 2;          // fewer candidates (of those possible): unusable
  double weight_outside_region = 0.7;

  // filter_neighbours
  double min_area = 0.05;
  double min_scale = 0.2, max_scale = 3.2;
  double min_angle = 3.0 * std::numbers::pi / 180.0;
  double max_angle = 65.0 * std::numbers::pi / 180.0;
  std::size_t max_views = 12;

  // choose_source_views
  double min_score = 2.0;
  double min_score_ratio = 0.03;  // of the best score
};

// What the sparse cloud says about one image, besides its neighbours.
struct ViewPreparation {
  // Indices into Scene::points of points seen here and trusted, ascending.
  std::vector<std::uint32_t> init_points;
  // Range of lambda (DepthMap's depth) to search [m]: 0.9 min to 1.1 max over init_points. 0, 0 if
  // there are none.
  float min_depth = 0, max_depth = 0;
  std::string problem;  // why the image cannot be a reference view; empty: it can
  bool usable() const { return problem.empty(); }
};

// Fills neighbours (unfiltered, decreasing score, ties by index) and min/average/max depth (z-depth
// in the camera frame, all points seen) of every calibrated image, from scene.points; returns one
// ViewPreparation an image. theta is the angle between the two rays in the medium at the point; the
// footprint f / d is generalised to the smaller singular value of the projection's Jacobian (with
// the rows scaled to the focal length fx), which for a pinhole is fx / z. Observations that the
// camera cannot have made (behind it, outside the port's field), of points that are not finite and
// of uncalibrated images are ignored, repeated ones count once. Linear in the pairs of
// observations of a point. Error for views of images that do not exist.
std::vector<ViewPreparation> score_neighbours(Scene& scene,
                                              const ViewSelectionOptions& options = {},
                                              const ProgressSink& progress = {});

// What scoring takes in memory [bytes], at most.
struct ScoringSize {
  std::uint64_t images = 0, points = 0, observations = 0;
  std::uint64_t neighbours = 0;  // entries in the lists of all images
};
struct ScoringMemory {
  std::uint64_t work = 0;  // given back at its end
  std::uint64_t kept = 0;  // the lists of neighbours and of points
};
ScoringMemory scoring_memory(const ScoringSize& size);

// The size of a scene, with most_neighbours.
ScoringSize scoring_size(const Scene& scene, const ViewSelectionOptions& options = {});

// A bound on the neighbours of all images, from `pairs`, the ordered pairs of views of a point.
std::uint64_t most_neighbours(std::uint64_t images, std::uint64_t pairs,
                              const ViewSelectionOptions& options = {});

// A closer bound: how many there are if each camera can have made its observations. Takes a part of
// the time and of the memory that scoring takes. Error for views of images that do not exist.
std::uint64_t count_neighbours(const Scene& scene, const ViewSelectionOptions& options = {});

// The working list of an image: from the worst on, entries with too small an area or scale or angle
// out of range leave while more than max(4, 3/4 max_views) remain; then the best max_views.
std::vector<ViewScore> filter_neighbours(const std::vector<ViewScore>& neighbours,
                                         const ViewSelectionOptions& options = {});

// The first `number_views` (0: all) of a working list whose score is at least
// max(min_score, min_score_ratio * best). Empty if there is none.
std::vector<ViewScore> choose_source_views(const std::vector<ViewScore>& filtered,
                                           std::size_t number_views,
                                           const ViewSelectionOptions& options = {});

// Why choose_source_views found none, from an image's neighbours, for a message.
std::string why_no_source_view(const std::vector<ViewScore>& neighbours,
                               const ViewSelectionOptions& options = {});

}  // namespace axial
