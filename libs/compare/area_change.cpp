// SPDX-License-Identifier: GPL-3.0-or-later
#include "compare/area_change.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "compare/changes.h"
#include "geometry/polygon_pieces.h"

namespace axial::compare {
namespace {

// The pixels of a grid that a polygon may touch.
cv::Rect pixels_of(const map::Area& area, const map::MapGrid& grid) {
  Eigen::AlignedBox2d box;
  for (const auto& part : area.parts)
    for (const Eigen::Vector2d& corner : part.front()) box.extend(corner);
  const auto index = [&](double length, int count) {
    return static_cast<int>(std::clamp(std::floor(length / grid.pixel), 0.0, double{1} * count));
  };
  const int left = index(box.min().x() - grid.left, grid.columns),
            right = index(box.max().x() - grid.left + grid.pixel, grid.columns),
            top = index(grid.top - box.max().y(), grid.rows),
            bottom = index(grid.top - box.min().y() + grid.pixel, grid.rows);
  return {left, top, right - left, bottom - top};
}

map::MapGrid part_of(const map::MapGrid& grid, const cv::Rect& pixels) {
  return {grid.left + pixels.x * grid.pixel, grid.top - pixels.y * grid.pixel, grid.pixel,
          pixels.width, pixels.height};
}

// The differences at the pixels in the polygon; NaN elsewhere.
cv::Mat1f differences_in(const map::Area& area, const cv::Mat1f& difference,
                         const map::MapGrid& grid) {
  const Eigen::Vector2d origin(grid.left, grid.top);  // so that large coordinates keep digits
  std::vector<geometry::PolygonPieces> parts;
  for (const auto& rings : area.parts) {
    std::vector<geometry::Ring> local = rings;
    for (geometry::Ring& ring : local)
      for (Eigen::Vector2d& corner : ring) corner -= origin;
    parts.emplace_back(local);
  }
  cv::Mat1f inside = difference.clone();
  parallel_for(static_cast<std::size_t>(inside.rows), [&](std::size_t row) {
    const auto y = static_cast<int>(row);
    for (int x = 0; x < inside.cols; ++x) {
      const Eigen::Vector2d at = grid.centre(y, x, 0).head<2>() - origin;
      if (std::ranges::none_of(parts, [&](const auto& part) { return part.contains(at); }))
        inside(y, x) = std::numeric_limits<float>::quiet_NaN();
    }
  });
  return inside;
}

}  // namespace

AreaChange change_in(const Comparison& comparison, const map::Area& area) {
  AreaChange change;
  const cv::Rect pixels = pixels_of(area, comparison.grid);
  if (pixels.empty()) return change;
  const map::MapGrid grid = part_of(comparison.grid, pixels);
  const cv::Mat1f difference = differences_in(area, comparison.difference(pixels), grid);
  const cv::Mat1f sigma = comparison.sigma(pixels);
  double sum = 0, variance = 0, count = 0;
  for (int y = 0; y < difference.rows; ++y)
    for (int x = 0; x < difference.cols; ++x) {
      const auto value = static_cast<double>(difference(y, x)),
                 deviation = static_cast<double>(sigma(y, x));
      if (std::isnan(value)) continue;
      sum += value, variance += deviation * deviation, ++count;
      if (std::abs(value) <= std::abs(change.largest)) continue;
      change.largest = value, change.largest_sigma = deviation;
    }
  if (!(count > 0)) return change;
  const double pixel = grid.pixel * grid.pixel;
  const double deviation = std::sqrt(comparison.noise.correlation * variance);
  change.compared = count * pixel;
  change.net = sum * pixel, change.net_sigma = deviation * pixel;
  change.mean = sum / count, change.mean_sigma = deviation / count;
  ChangeOptions options;
  options.least_pixels = comparison.least_pixels;
  const Changes found = find_changes(
      difference, sigma, {grid, comparison.registration, comparison.noise.correlation}, options);
  change.came = found.came, change.gone = found.gone;
  return change;
}

}  // namespace axial::compare
