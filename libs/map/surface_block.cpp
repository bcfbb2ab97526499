// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/surface_block.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/plane_cross.h"

namespace axial::map {
namespace {

// Twice the signed area of the triangle (from, to, place). The ends of the edge are ordered by
// their places, so that the two faces at an edge get exactly opposite numbers, also if they have
// vertices of their own.
double side_of_edge(const FaceCorners& corners, int from, int to, const Eigen::Vector2d& place) {
  const auto key = [&](int corner) {
    return std::pair(corners.at(0, corner), corners.at(1, corner));
  };
  const bool swapped = key(from) > key(to);
  const Eigen::Vector2d a = corners.at.col(swapped ? to : from);
  const Eigen::Vector2d b = corners.at.col(swapped ? from : to);
  const double side = plane_cross(b - a, place - a);
  return swapped ? -side : side;
}

// The signed parts of the triangle's area that belong to its corners, seen from `place`.
Eigen::Vector3d parts_at(const FaceCorners& corners, const Eigen::Vector2d& place) {
  return {side_of_edge(corners, 1, 2, place), side_of_edge(corners, 2, 0, place),
          side_of_edge(corners, 0, 1, place)};
}

// The blocks that the bounding box of a face touches, with a border of a pixel: columns and rows,
// the ends included.
struct BlockRange {
  int x0, x1, y0, y1;
  std::uint64_t count() const {
    return static_cast<std::uint64_t>(x1 - x0 + 1) * static_cast<std::uint64_t>(y1 - y0 + 1);
  }
};

BlockRange blocks_of(const FaceCorners& corners, const MapGrid& grid, int block_size) {
  const Eigen::Array2d low = corners.at.rowwise().minCoeff().array() - 1;
  const Eigen::Array2d high = corners.at.rowwise().maxCoeff().array() + 1;
  const auto block = [&](double at, int pixels) {
    return static_cast<int>(std::clamp(at, 0.0, pixels - 1.0)) / block_size;
  };
  return {block(low.x(), grid.columns), block(high.x(), grid.columns), block(low.y(), grid.rows),
          block(high.y(), grid.rows)};
}

int blocks_along(int pixels, int block_size) {
  return (pixels + block_size - 1) / block_size;
}

// The samples of one axis between two places [samples], limited to the block.
std::pair<int, int> samples_between(double low, double high, int count) {
  const double last = count - 1.0;
  return {static_cast<int>(std::clamp(std::ceil(low - 0.5), 0.0, static_cast<double>(count))),
          static_cast<int>(std::clamp(std::floor(high - 0.5), -1.0, last))};
}

void draw(const FaceCorners& corners, std::uint32_t index, SurfaceBlock& block) {
  const Eigen::Array2d begin(block.pixels.x, block.pixels.y);
  const Eigen::Array2d low = (corners.at.rowwise().minCoeff().array() - begin) * block.samples;
  const Eigen::Array2d high = (corners.at.rowwise().maxCoeff().array() - begin) * block.samples;
  constexpr double kRounding = 1e-6;  // [samples], of the bounds above
  const auto [x0, x1] =
      samples_between(low.x() - kRounding, high.x() + kRounding, block.heights.cols);
  const auto [y0, y1] =
      samples_between(low.y() - kRounding, high.y() + kRounding, block.heights.rows);
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const Eigen::Vector3d parts = parts_at(corners, block.place(y, x));
      if (parts.minCoeff() < 0 && parts.maxCoeff() > 0) continue;
      const double area = parts.sum();
      if (area == 0) continue;
      const auto height = static_cast<float>(parts.dot(corners.height) / area);
      if (!(height > block.heights(y, x)) && block.faces(y, x) >= 0) continue;
      block.heights(y, x) = height;
      block.faces(y, x) = static_cast<int>(index);
    }
}

}  // namespace

FaceCorners corners_of(const Mesh& mesh, std::uint32_t face, const MapFrame& frame,
                       const MapGrid& grid) {
  // The upper left corner of the map, seen from the origin of the mesh's frame.
  const Eigen::Vector2d corner(grid.left - frame.origin.x(), grid.top - frame.origin.y());
  FaceCorners corners;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d x =
        frame.axes * mesh.vertices[mesh.faces[face][static_cast<std::size_t>(k)]].cast<double>();
    corners.at.col(k) << (x.x() - corner.x()) / grid.pixel, (corner.y() - x.y()) / grid.pixel;
    corners.height[k] = x.z();
  }
  return corners;
}

FaceBins::FaceBins(const Mesh& mesh, const MapFrame& frame, const MapGrid& grid, int block_size)
    : columns_(grid.columns),
      rows_(grid.rows),
      block_size_(block_size),
      block_columns_(blocks_along(grid.columns, block_size)) {
  const int block_rows = blocks_along(grid.rows, block_size);
  const auto blocks =
      static_cast<std::size_t>(block_columns_) * static_cast<std::size_t>(block_rows);
  faces_ = geometry::lists_of<std::uint32_t, std::uint64_t>(blocks, [&](const auto& add) {
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
      const BlockRange range = blocks_of(corners_of(mesh, f, frame, grid), grid, block_size);
      for (int y = range.y0; y <= range.y1; ++y)
        for (int x = range.x0; x <= range.x1; ++x)
          add(static_cast<std::size_t>(y) * static_cast<std::size_t>(block_columns_) +
                  static_cast<std::size_t>(x),
              f);
    }
  });
}

cv::Rect FaceBins::pixels(std::size_t block) const {
  const int x = static_cast<int>(block % static_cast<std::size_t>(block_columns_)) * block_size_;
  const int y = static_cast<int>(block / static_cast<std::size_t>(block_columns_)) * block_size_;
  return {x, y, std::min(block_size_, columns_ - x), std::min(block_size_, rows_ - y)};
}

std::uint64_t FaceBins::bytes(const Mesh& mesh, const MapFrame& frame, const MapGrid& grid,
                              int block_size) {
  std::uint64_t entries = 0;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    entries += blocks_of(corners_of(mesh, f, frame, grid), grid, block_size).count();
  const auto blocks = static_cast<std::uint64_t>(blocks_along(grid.columns, block_size)) *
                      static_cast<std::uint64_t>(blocks_along(grid.rows, block_size));
  return entries * sizeof(std::uint32_t) + 2 * blocks * sizeof(std::uint64_t);
}

SurfaceBlock look_from_above(const Mesh& mesh, const MapFrame& frame, const MapGrid& grid,
                             const cv::Rect& pixels, int samples,
                             std::span<const std::uint32_t> faces) {
  SurfaceBlock block{pixels, samples, {}, {}};
  const cv::Size size(pixels.width * samples, pixels.height * samples);
  block.heights = cv::Mat1f(size, std::numeric_limits<float>::quiet_NaN());
  block.faces = cv::Mat_<int>(size, -1);
  for (const std::uint32_t face : faces) draw(corners_of(mesh, face, frame, grid), face, block);
  return block;
}

Eigen::Vector3d weights_at(const FaceCorners& corners, const Eigen::Vector2d& place) {
  const Eigen::Vector3d parts = parts_at(corners, place);
  return parts / parts.sum();
}

}  // namespace axial::map
