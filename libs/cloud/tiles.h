// SPDX-License-Identifier: GPL-3.0-or-later
// Tiles: boxes that divide space, so that fuse() can make a cloud part by part.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "axial/cloud.h"
#include "base/order_statistics.h"
#include "scene/depth_map.h"
#include "scene/scene.h"

namespace axial::cloud {

// The tile with each side moved outwards by `margin` [world units, 0 or more].
Tile grown(const Tile& tile, double margin);

// The axes of the tiles of a scene (rows): those of its region of interest, or of the world without
// a region.
Eigen::Matrix3d tile_axes(const Scene& scene);

// The margin of a tile from the sizes of which a margin is a multiple, such as the widths of pixels
// at the points of the tile: `factor` times their 95th percentile. 0 without sizes.
template <class T>
double tile_margin(double factor, const std::vector<T>& sizes) {
  if (sizes.empty()) return 0;
  return factor * static_cast<double>(value_at_place(sizes, (sizes.size() - 1) * 19 / 20));
}

// Divides space into `count` tiles with about equal numbers of `points` [world]. Each place belongs
// to exactly one tile: outer tiles reach to infinity. The tiles have the axes `rotation` (its
// rows). A box is divided across the axis along which the middle nine tenths of its points extend
// farthest, in proportion to the numbers of tiles on both sides. The two parts are divided in turn;
// the tiles of the lower part come first. Without equal coordinates, the numbers of points of any
// two tiles differ by at most 2. A tile may be empty if there are fewer points than tiles, or if
// points have equal coordinates. Precondition: `count` is at least 1, and the points are finite.
std::vector<Tile> make_tiles(std::span<const Eigen::Vector3f> points, std::size_t count,
                             const Eigen::Matrix3d& rotation);

// Returns for each box of `boxes` whether the map has a point in it. The answer may also be
// true if points of the map are near the box: all pixels of a small block are tested at once, with
// the box around their points. Precondition: all boxes have the same rotation.
std::vector<bool> boxes_seen(const DepthMap& map, std::span<const Tile> boxes);

}  // namespace axial::cloud
