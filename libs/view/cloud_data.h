// SPDX-License-Identifier: GPL-3.0-or-later
// The form in which a cloud is written for the viewer (apps/ViewScene/page/src/cloud.js reads it).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>

#include "scene/point_cloud.h"
#include "view/cloud_sample.h"

namespace axial::view {

// The largest number of points of a chunk: the number of a list of views has 16 bits.
inline constexpr std::size_t kMostChunkPoints = 65536;

// A chunk as bytes. Numbers are little-endian. `bytes` consists of these arrays, for n points:
//   - 3 n uint16: positions, as fractions of the box: low + size * value / 65535
//   - n uint16: the number of the list of views of each point, if the cloud has views
//   - the lists of views, if the cloud has views, in the order of their numbers: a uint16 with the
//     length of the list, and as many uint16, the numbers of cameras
//   - n uint16: the errors of the points in units of PointErrors::step, if there are errors
//   - 3 n uint8: red, green, blue; grey if the cloud has no colours
// Points with the same views share one list.
struct ChunkData {
  Eigen::Vector3f low = Eigen::Vector3f::Zero();   // lower corner of the box of all points
  Eigen::Vector3f size = Eigen::Vector3f::Zero();  // of the box; a side may be 0
  std::size_t lists = 0;                           // the number of lists of views
  std::string bytes;
};

// The distances [m] of all points of a cloud to the true surface. 65535 `step`s mean this distance
// or more.
struct PointErrors {
  std::span<const float> distances;  // empty: no errors
  double step = 0;                   // [m]; 0: no errors
};

// The step for `distances`: fine enough for their median, and coarse enough for the largest, up to
// 200 times the median. 0 without distances.
double error_step(std::span<const float> distances);

// The bytes of `chunk`. `camera_of[i]` is the number of the camera that belongs to view i of the
// cloud (PointCloud::view_images). Error for a chunk with more than kMostChunkPoints points, for a
// view without a camera number, and for a camera number above 65535.
ChunkData chunk_data(const PointCloud& cloud, const PointChunk& chunk,
                     std::span<const std::uint32_t> camera_of, const PointErrors& errors = {});

}  // namespace axial::view
