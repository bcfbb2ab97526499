// SPDX-License-Identifier: GPL-3.0-or-later
#include "labels/fill.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace axial::labels {

void fill(const std::vector<std::vector<geometry::Ring>>& parts, std::uint16_t value,
          cv::Mat1w& mask) {
  double low = mask.rows, high = -1;
  for (const auto& part : parts)
    for (const geometry::Ring& ring : part)
      for (const Eigen::Vector2d& corner : ring) {
        low = std::min(low, corner.y());
        high = std::max(high, corner.y());
      }
  const int last = static_cast<int>(std::floor(std::min(high, mask.rows - 1.0)));
  std::vector<double> crossings;
  for (int y = static_cast<int>(std::ceil(std::max(low, 0.0))); y <= last; ++y) {
    crossings.clear();
    for (const auto& part : parts)
      for (const geometry::Ring& ring : part)
        for (std::size_t i = 0; i < ring.size(); ++i) {
          const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
          if ((a.y() <= y) == (b.y() <= y)) continue;
          crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
        }
    std::ranges::sort(crossings);
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const int begin = std::max(0, static_cast<int>(std::ceil(crossings[i])));
      const int end = std::min(mask.cols - 1, static_cast<int>(std::floor(crossings[i + 1])));
      for (int x = begin; x <= end; ++x) mask(y, x) = value;
    }
  }
}

}  // namespace axial::labels
