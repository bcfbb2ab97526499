// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/cloud_data.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include "base/error.h"
#include "base/order_statistics.h"
#include "view/little_endian.h"

namespace axial::view {
namespace {

using Views = std::vector<std::uint16_t>;

// The lists of views of a chunk: points with the same views share one list.
class ViewLists {
 public:
  std::uint16_t number_of(const Views& views) {
    const auto [at, added] = numbers_.try_emplace(views, static_cast<std::uint16_t>(size()));
    if (added) {
      append_u16(bytes_, static_cast<std::uint16_t>(views.size()));
      for (const std::uint16_t view : views) append_u16(bytes_, view);
    }
    return at->second;
  }

  std::size_t size() const { return numbers_.size(); }
  const std::string& bytes() const { return bytes_; }

 private:
  std::map<Views, std::uint16_t> numbers_;
  std::string bytes_;
};

Views cameras_of(std::span<const std::uint32_t> images, std::span<const std::uint32_t> camera_of) {
  Views views;
  for (const std::uint32_t image : images) {
    if (image >= camera_of.size())
      fail("view_indices has image {}, but the scene has {} images", image, camera_of.size());
    const std::uint32_t camera = camera_of[image];
    if (camera == kNoId) fail("view_indices has image {}, which is not calibrated", image);
    if (camera > 0xFFFFu) fail("more than 65536 images cannot be shown");
    views.push_back(static_cast<std::uint16_t>(camera));
  }
  return views;
}

void append_positions(const PointCloud& cloud, const PointChunk& chunk, ChunkData& data) {
  Eigen::AlignedBox3f box;
  for (const std::uint32_t i : chunk.points) box.extend(cloud.positions[i]);
  data.low = box.min();
  data.size = box.sizes();
  for (const std::uint32_t i : chunk.points) {
    for (int k = 0; k < 3; ++k) {
      const double above = static_cast<double>(cloud.positions[i][k]) - data.low[k];
      const double share = data.size[k] > 0 ? above / data.size[k] : 0;
      append_u16(data.bytes, static_cast<std::uint16_t>(std::lround(65535 * share)));
    }
  }
}

void append_views(const PointCloud& cloud, const PointChunk& chunk,
                  std::span<const std::uint32_t> camera_of, ChunkData& data) {
  if (cloud.view_begin.empty()) return;
  ViewLists lists;
  for (const std::uint32_t i : chunk.points)
    append_u16(data.bytes, lists.number_of(cameras_of(cloud.views_of(i), camera_of)));
  data.bytes += lists.bytes();
  data.lists = lists.size();
}

void append_errors(const PointErrors& errors, const PointChunk& chunk, ChunkData& data) {
  if (errors.distances.empty()) return;
  for (const std::uint32_t i : chunk.points)
    append_u16(data.bytes, static_cast<std::uint16_t>(std::lround(
                               std::clamp(errors.distances[i] / errors.step, 0.0, 65535.0))));
}

}  // namespace

double error_step(std::span<const float> distances) {
  if (distances.empty()) return 0;
  const float middle = upper_median(std::vector<float>(distances.begin(), distances.end()));
  const double most = *std::ranges::max_element(distances);
  const double limit = middle > 0 ? std::min(most, 200.0 * middle) : most;
  return std::max(limit, 1e-9) / 65535;
}

ChunkData chunk_data(const PointCloud& cloud, const PointChunk& chunk,
                     std::span<const std::uint32_t> camera_of, const PointErrors& errors) {
  if (chunk.points.empty() || chunk.points.size() > kMostChunkPoints)
    fail("a chunk has {} points, expected 1 to {}", chunk.points.size(), kMostChunkPoints);
  constexpr Rgb kGrey{160, 160, 160};
  ChunkData data;
  append_positions(cloud, chunk, data);
  append_views(cloud, chunk, camera_of, data);
  append_errors(errors, chunk, data);
  for (const std::uint32_t i : chunk.points)
    for (const std::uint8_t value : cloud.colors.empty() ? kGrey : cloud.colors[i])
      data.bytes.push_back(static_cast<char>(value));
  return data;
}

}  // namespace axial::view
