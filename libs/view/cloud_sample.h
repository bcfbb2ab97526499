// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses points of a cloud for display, and divides them into chunks that a viewer can load one
// after the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/point_cloud.h"

namespace axial::view {

// A random sample of the points of a cloud that is added in portions. Whether a point belongs to
// the sample depends only on its number in the cloud, on the number of all points and on `most`.
class CloudSample {
 public:
  // `most`: the sample has about this many points, and all points if the cloud has no more.
  explicit CloudSample(std::size_t most) : most_(most) {}

  // Adds the next portion of a cloud of `all_points` points. Normals, errors, confidences and the
  // weights of views are left out. Precondition: all portions have the same properties.
  void add(const PointCloud& portion, std::size_t all_points);

  // The number of points that were added, in the sample or not.
  std::size_t added() const { return added_; }

  // Returns the sample, in the order of the cloud, and leaves this object empty. If no point was
  // taken by chance, the sample is the first point.
  PointCloud take();

 private:
  std::size_t most_;
  std::size_t added_ = 0;
  PointCloud sample_;
  PointCloud first_;  // the first point of the cloud, in case that the sample stays empty
};

// A part of a cloud: points of one level that are near each other, in random order.
struct PointChunk {
  std::size_t level = 0;
  std::vector<std::uint32_t> points;  // indices into the cloud
};

// Divides the points into chunks of at most `largest` points. The points of the levels 0 to k
// together are a random sample of the cloud, for every k: level 0 has `largest` points, and the
// levels 0 to k together have 4^k times as many, as long as there are enough points. Inside a
// level, each chunk has its own part of space, so that chunks outside the picture need not be
// drawn. Chunks are sorted by level. Error for 2^32 - 1 points or more. Precondition: `largest`
// is at least 1.
std::vector<PointChunk> divide_into_chunks(const PointCloud& cloud, std::size_t largest);

}  // namespace axial::view
