// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/tiles.h"

#include <algorithm>

#include "base/parallel.h"
#include "scene/camera_model.h"

namespace axial::cloud {
namespace {

using Along = std::vector<Eigen::Vector3d>;  // coordinates along the axes of the tiles

// The number of the point below which the share `share` of `count` points lies.
double extent(std::span<const Eigen::Vector3d> points, int axis) {
  std::vector<double> values;
  for (const Eigen::Vector3d& point : points) values.push_back(point[axis]);
  const double low = lower_quantile(values, 0.05);
  return lower_quantile(std::move(values), 0.95) - low;
}

int longest_axis(std::span<const Eigen::Vector3d> points) {
  if (points.empty()) return 0;
  int longest = 0;
  double most = extent(points, 0);
  for (int axis = 1; axis < 3; ++axis)
    if (const double here = extent(points, axis); here > most) {
      longest = axis;
      most = here;
    }
  return longest;
}

// The place of the cut that leaves `below` points on its lower side. Sorts the points so that these
// come first.
double cut_at(std::span<Eigen::Vector3d> points, std::size_t below, int axis, const Tile& box) {
  if (points.empty())  // any place inside the box
    return std::clamp(0.0, box.low[axis], box.high[axis]);
  const auto at = points.begin() + static_cast<std::ptrdiff_t>(std::min(below, points.size() - 1));
  std::nth_element(
      points.begin(), at, points.end(),
      [axis](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a[axis] < b[axis]; });
  return (*at)[axis];
}

void divide(std::span<Eigen::Vector3d> points, std::size_t count, const Tile& box,
            std::vector<Tile>& tiles) {
  if (count == 1) {
    tiles.push_back(box);
    return;
  }
  const std::size_t lower = count / 2;
  const std::size_t below = (points.size() * lower + count / 2) / count;
  const int axis = longest_axis(points);
  Tile first = box, second = box;
  first.high[axis] = second.low[axis] = cut_at(points, below, axis, box);
  divide(points.first(below), lower, first, tiles);
  divide(points.subspan(below), count - lower, second, tiles);
}

// The box around some points, along the axes of the tiles.
struct Bounds {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(Tile::kInfinity);
  Eigen::Vector3d high = Eigen::Vector3d::Constant(-Tile::kInfinity);

  void add(const Eigen::Vector3d& along) {
    low = low.cwiseMin(along);
    high = high.cwiseMax(along);
  }
  bool meets(const Tile& box) const {
    return (high.array() >= box.low.array()).all() && (low.array() < box.high.array()).all();
  }
};

constexpr int kBlock = 16;  // [px]

template <class Camera>
Bounds bounds_of_block(const DepthMap& map, const Camera& camera, const Eigen::Matrix3d& rotation,
                       const cv::Rect& block) {
  Bounds bounds;
  for (int y = block.y; y < block.y + block.height; ++y)
    for (int x = block.x; x < block.x + block.width; ++x) {
      const float depth = map.depth(y, x);
      if (!(depth > 0)) continue;
      const Eigen::Vector3d point =
          map.pose.to_world(camera.ray({x, y}).at(static_cast<double>(depth)));
      // Fusion tests the point in single precision.
      bounds.add(rotation * point.cast<float>().cast<double>());
    }
  return bounds;
}

std::vector<Bounds> bounds_of_blocks(const DepthMap& map, const Eigen::Matrix3d& rotation) {
  const int columns = (map.width() + kBlock - 1) / kBlock;
  const int rows = (map.height() + kBlock - 1) / kBlock;
  std::vector<Bounds> blocks(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  std::visit(
      [&](const auto& camera) {
        parallel_for(blocks.size(), [&](std::size_t i) {
          const int block = static_cast<int>(i);
          const cv::Rect inside(0, 0, map.width(), map.height());
          const cv::Rect pixels(kBlock * (block % columns), kBlock * (block / columns), kBlock,
                                kBlock);
          blocks[i] = bounds_of_block(map, camera, rotation, pixels & inside);
        });
      },
      make_camera<double>(map.camera));
  return blocks;
}

}  // namespace

Tile grown(const Tile& tile, double margin) {
  Tile larger = tile;
  larger.low.array() -= margin;
  larger.high.array() += margin;
  return larger;
}

Eigen::Matrix3d tile_axes(const Scene& scene) {
  return scene.region ? scene.region->rotation : Eigen::Matrix3d::Identity();
}

std::vector<Tile> make_tiles(std::span<const Eigen::Vector3f> points, std::size_t count,
                             const Eigen::Matrix3d& rotation) {
  Along along;
  for (const Eigen::Vector3f& point : points) along.push_back(rotation * point.cast<double>());
  std::vector<Tile> tiles;
  Tile space;
  space.rotation = rotation;
  divide(along, count, space, tiles);
  return tiles;
}

std::vector<bool> boxes_seen(const DepthMap& map, std::span<const Tile> boxes) {
  std::vector<bool> seen(boxes.size(), false);
  if (boxes.empty()) return seen;
  const std::vector<Bounds> blocks = bounds_of_blocks(map, boxes[0].rotation);
  for (std::size_t i = 0; i < boxes.size(); ++i)
    seen[i] = std::ranges::any_of(blocks, [&](const Bounds& block) {
      return (block.low.array() <= block.high.array()).all() && block.meets(boxes[i]);
    });
  return seen;
}

}  // namespace axial::cloud
