// SPDX-License-Identifier: GPL-3.0-or-later
// The options of the work on a scene: the resolution at which images are processed, the source
// views of each image, the region of interest, and how points are projected.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>

#include "axial/scene.h"

namespace axial {

// The resolution at which images are processed.
struct ResolutionOptions {
  unsigned level = 1;  // largest number of halvings of the image; 0: the image is not halved
  int min = 640;       // least longest side that halving may give [px]
  int max = 2560;      // upper bound of the longest side [px]
};

// How the source views of an image are chosen.
struct ViewSelectionOptions {
  double optimal_angle = 12.0 * std::numbers::pi / 180.0;  // best triangulation angle [rad]
  // With fewer shared sparse points, another image is no candidate for a source view.
  std::uint32_t min_shared_points = 3;
  std::size_t min_trusted_views = 2;  // a sparse point that fewer images see is not trusted
  std::size_t min_init_points = 4;    // an image with fewer trusted points is unusable
  // An image with fewer candidates is unusable. If the value is above the number of other
  // calibrated images, it is reduced to this number.
  std::size_t min_views = 2;
  double weight_outside_region = 0.7;  // weight of points outside Scene::region in the score

  // Limits for filter_neighbours(). A neighbour is unsuitable if its ViewScore::area, scale or
  // angle [rad] is outside the limits. `max_views`: largest number of neighbours that are kept.
  double min_area = 0.05;
  double min_scale = 0.2, max_scale = 3.2;
  double min_angle = 3.0 * std::numbers::pi / 180.0;
  double max_angle = 65.0 * std::numbers::pi / 180.0;
  std::size_t max_views = 12;

  // Limits for choose_source_views(). A neighbour with a smaller ViewScore::score than one of the
  // two limits is not chosen.
  double min_score = 2.0;
  double min_score_ratio = 0.03;  // relative to the best score
};

// Whether the region of interest is estimated.
enum class RegionMode {
  off = 0,      // there is no region
  on = 1,       // the region is estimated whenever this is possible
  adaptive = 2  // only if the cameras surround an object; otherwise there is no region
};

// How points are projected into a camera behind a port.
enum class ProjectionMethod {
  exact,
  line_search  // the paper's Algorithm 1, for comparison
};

}  // namespace axial
