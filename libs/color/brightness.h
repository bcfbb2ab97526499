// SPDX-License-Identifier: GPL-3.0-or-later
// How well a model explains the brightness of the same points from different distances.
#pragma once

#include <vector>

#include "color/restore.h"

namespace axial::color {

// The light of points, as a share of the mean restored light of each point.
struct BrightnessAt {
  double way = 0;  // the median of the ways [m]
  // Medians over observations, R G B; 0 in channels that the model does not determine.
  Eigen::Array3f before = Eigen::Array3f::Zero(), after = Eigen::Array3f::Zero();
};

// In 12 layers of equally many observations, from near to far. With a model that fits, `after` is
// near 1 everywhere. Empty with fewer than 240 observations.
std::vector<BrightnessAt> brightness_by_way(const Observations& observations,
                                            const WaterModel& model);

// How much the restored light of the same points differs by the place in the image: the root mean
// square over cells of the image (8 x 6) of log(light / mean restored light of the point), each the
// median over observations without shadows and determined channels. Light of lamps that was taken
// for daylight stays brighter in the middle.
double unevenness_by_place(const Observations& observations, const WaterModel& model);

}  // namespace axial::color
