// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/height_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "map/surface_block.h"

namespace axial::compare {
namespace {

constexpr int kBlock = 256;  // [px]

void fill_block(const map::SurfaceBlock& block, double lift, cv::Mat1f& heights) {
  const int n = block.samples;
  for (int y = 0; y < block.pixels.height; ++y)
    for (int x = 0; x < block.pixels.width; ++x) {
      double sum = 0;  // NaN if a sample has no surface
      for (int v = 0; v < n; ++v)
        for (int u = 0; u < n; ++u) sum += static_cast<double>(block.heights(y * n + v, x * n + u));
      heights(block.pixels.y + y, block.pixels.x + x) = static_cast<float>(sum / (n * n) + lift);
    }
}

// The slope from the neighbours `low` and `high` of `middle`, in direction of `high`.
double slope_between(float low, float middle, float high, double pixel) {
  const auto a = static_cast<double>(low), b = static_cast<double>(middle),
             c = static_cast<double>(high);
  if (std::isnan(a)) return std::isnan(c) ? 0 : (c - b) / pixel;
  return std::isnan(c) ? (b - a) / pixel : (c - a) / (2 * pixel);
}

float height_or_none(const cv::Mat1f& heights, int y, int x) {
  const bool inside = y >= 0 && x >= 0 && y < heights.rows && x < heights.cols;
  return inside ? heights(y, x) : std::numeric_limits<float>::quiet_NaN();
}

}  // namespace

cv::Mat1f height_map(const Mesh& mesh, const map::MapFrame& frame, const map::MapGrid& grid,
                     double base, int samples, const ProgressSink& progress) {
  cv::Mat1f heights(grid.rows, grid.columns, std::numeric_limits<float>::quiet_NaN());
  const map::FaceBins bins(mesh, frame, grid, kBlock);
  ProgressCounter counter(progress, bins.blocks());
  parallel_for(bins.blocks(), [&](std::size_t b) {
    if (!bins.faces(b).empty())
      fill_block(look_from_above(mesh, frame, grid, bins.pixels(b), samples, bins.faces(b)),
                 frame.origin.z() - base, heights);
    counter.add();
  });
  return heights;
}

std::uint64_t bytes_of_height_map(const Mesh& mesh, const map::MapFrame& frame,
                                  const map::MapGrid& grid) {
  constexpr std::uint64_t kOfBlock = 8 * 9 * kBlock * kBlock;  // 3 x 3 samples per pixel
  return map::FaceBins::bytes(mesh, frame, grid, kBlock) + kOfBlock * thread_count() +
         static_cast<std::uint64_t>(grid.pixels()) * sizeof(float);
}

Eigen::Vector2d slope_at(const cv::Mat1f& heights, int y, int x, double pixel) {
  const auto at = [&](int v, int u) { return height_or_none(heights, v, u); };
  const float middle = heights(y, x);  // the map's y axis points to smaller rows
  return {slope_between(at(y, x - 1), middle, at(y, x + 1), pixel),
          slope_between(at(y + 1, x), middle, at(y - 1, x), pixel)};
}

double bend_at(const cv::Mat1f& heights, int y, int x) {
  double bend = 0;
  for (const auto& [down, right] : {std::pair(0, 1), std::pair(1, 0)}) {
    const float low = height_or_none(heights, y - down, x - right);
    const float high = height_or_none(heights, y + down, x + right);
    if (std::isnan(low) || std::isnan(high)) continue;
    bend = std::max(bend, std::abs(static_cast<double>(low - heights(y, x)) +
                                   static_cast<double>(high - heights(y, x))));
  }
  return bend;
}

}  // namespace axial::compare
