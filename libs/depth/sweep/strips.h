// SPDX-License-Identifier: GPL-3.0-or-later
// The strips of rows into which a sweep divides a map. While a strip is processed, pixels outside
// it are read as they were before the sweep, so that strips are independent.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "depth/plane_map.h"
#include "depth/smoothness.h"

namespace axial::depth {

inline constexpr int kStripHeight = 32;  // rows of a strip; the last strip may have fewer

// The surface at the up to four pixels that share an edge with a pixel. Pixels without a plane are
// left out.
struct Neighbourhood {
  std::array<SurfacePoint, 4> points;
  std::size_t count = 0;

  std::span<const SurfacePoint> all() const { return {points.data(), count}; }
};

// The strips of a map, numbered from the top from 0.
class Strips {
 public:
  // The map must outlive the strips.
  explicit Strips(const PlaneMap& map) : map_(map) {}

  int count() const { return (map_.height + kStripHeight - 1) / kStripHeight; }

  // The rows of a strip: [top, bottom).
  int top(int strip) const { return strip * kStripHeight; }
  int bottom(int strip) const { return std::min(top(strip) + kStripHeight, map_.height); }

  // Copies the two rows at each edge between strips: the last row of a strip and the first row of
  // the next. Call this function before the sweep changes a pixel.
  void copy_edges() {
    const auto width = static_cast<std::ptrdiff_t>(map_.width);
    edges_.clear();
    for (int strip = 0; strip + 1 < count(); ++strip) {
      const auto begin = map_.pixels.begin() + ((strip + 1) * kStripHeight - 1) * width;
      edges_.insert(edges_.end(), begin, begin + 2 * width);
    }
  }

  // Returns pixel (x, y): its current state if the pixel belongs to the strip, or its state at the
  // call of copy_edges() if the pixel is in the row above or below the strip. Precondition: the
  // pixel lies inside the map, in the strip or in one of these two rows.
  const PlanePixel& neighbour(int strip, int x, int y) const {
    const int first = top(strip);
    if (y >= first && y < first + kStripHeight) return map_.at(x, y);
    const int edge = y < first ? strip - 1 : strip;
    const int row = y < first ? 0 : 1;
    return edges_[static_cast<std::size_t>((edge * 2 + row) * map_.width + x)];
  }

  // Returns the surface at the pixels next to pixel (x, y) of the strip, with the states that
  // neighbour() returns.
  Neighbourhood neighbourhood(int strip, int x, int y) const {
    Neighbourhood around;
    const auto add = [&](int nx, int ny) {
      if (nx < 0 || ny < 0 || nx >= map_.width || ny >= map_.height) return;
      const PlanePixel& pixel = neighbour(strip, nx, ny);
      if (!(pixel.plane.depth > 0)) return;
      const Eigen::Vector3f& p = pixel.point;
      const Eigen::Vector3f& n = pixel.plane.normal;
      around.points[around.count++] = {{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}};
    };
    add(x - 1, y);
    add(x, y - 1);
    add(x + 1, y);
    add(x, y + 1);
    return around;
  }

 private:
  const PlaneMap& map_;
  std::vector<PlanePixel> edges_;  // the two rows at each edge between strips
};

}  // namespace axial::depth
