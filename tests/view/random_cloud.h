// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <random>

#include "scene/point_cloud.h"

namespace axial::view::testing {

// A cloud of `points` random points in a box of 2 x 1 x 0.5, with colours, and with 0 to 3 of the
// images 0 to 4 as views.
inline PointCloud random_cloud(std::size_t points, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  PointCloud cloud;
  cloud.view_begin = {0};
  for (std::size_t i = 0; i < points; ++i) {
    cloud.positions.emplace_back(2 * unit(random) - 7, unit(random), 0.5f * unit(random));
    cloud.colors.push_back(
        {static_cast<std::uint8_t>(random() % 256), 7, static_cast<std::uint8_t>(i % 256)});
    for (std::uint32_t image = 0, left = random() % 4; left > 0; --left, ++image)
      cloud.view_images.push_back(image + random() % 2);
    cloud.view_begin.push_back(cloud.view_images.size());
  }
  return cloud;
}

}  // namespace axial::view::testing
