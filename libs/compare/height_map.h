// SPDX-License-Identifier: GPL-3.0-or-later
// Heights of a mesh on all pixels of a map, and their slopes.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "base/progress.h"
#include "map/frame.h"
#include "scene/mesh.h"

namespace axial::compare {

// The height of the mesh at each pixel of `grid`, above the height `base` [m in the map `frame`].
// NaN where the mesh has no surface. The height is the mean of `samples` x `samples` samples of
// the pixel, each of which is the highest point of the mesh on the vertical line through it.
// `samples` is odd: with 1, the height is that of the pixel's centre. If one of the samples has no
// surface, the pixel has none. `progress` counts blocks of the map. The result does not depend on
// the number of threads.
cv::Mat1f height_map(const Mesh& mesh, const map::MapFrame& frame, const map::MapGrid& grid,
                     double base, int samples = 1, const ProgressSink& progress = {});

// The memory [bytes] of height_map() with its result.
std::uint64_t bytes_of_height_map(const Mesh& mesh, const map::MapFrame& frame,
                                  const map::MapGrid& grid);

// The slope of a map of heights at pixel (x, y): change of height per metre along the map's x and
// y axes. It follows from the neighbours on both sides, or from the pixel and one neighbour if the
// other one has no surface. It is 0 along an axis without such neighbours. `pixel`: width of a
// pixel [m]. Precondition: the pixel has a height.
Eigen::Vector2d slope_at(const cv::Mat1f& heights, int y, int x, double pixel);

// How much a map of heights bends at pixel (x, y): the larger one of the absolute second
// differences of heights along both axes [m]. 0 along an axis if a neighbour has no surface.
// Precondition: the pixel has a height.
double bend_at(const cv::Mat1f& heights, int y, int x);

// The values of `value_at`(y, x) that are not NaN, at no more than about a million pixels that are
// spread evenly over a map: for statistics of the whole map.
template <class ValueAt>
std::vector<double> spread_values(const cv::Size& size, const ValueAt& value_at) {
  constexpr double kMost = 1e6;
  const double pixels = static_cast<double>(size.width) * size.height;
  const int stride = std::max(1, static_cast<int>(std::ceil(std::sqrt(pixels / kMost))));
  std::vector<double> values;
  for (int y = stride / 2; y < size.height; y += stride)
    for (int x = stride / 2; x < size.width; x += stride)
      if (const double value = value_at(y, x); !std::isnan(value)) values.push_back(value);
  return values;
}

}  // namespace axial::compare
