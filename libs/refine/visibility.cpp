// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/visibility.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace axial::refine {
namespace {

bool is_seen(const VertexImage& image, const Eigen::Vector3f& normal, const Raster& raster) {
  if (!image.visible()) return false;
  const float right = static_cast<float>(raster.depth.cols - 1);
  const float bottom = static_cast<float>(raster.depth.rows - 1);
  if (!(image.x >= 0 && image.y >= 0 && image.x <= right && image.y <= bottom)) return false;
  if (!(normal.dot(image.ray()) < -kLeastCosine)) return false;
  const int x = std::min(static_cast<int>(image.x), raster.depth.cols - 2);
  const int y = std::min(static_cast<int>(image.y), raster.depth.rows - 2);
  const float* above = raster.depth[y] + x;
  const float* below = raster.depth[y + 1] + x;
  return image.depth <= std::max({above[0], above[1], below[0], below[1]}) * (1 + kBehind);
}

}  // namespace

void mark_seen(std::span<const VertexImage> images, const Shape& shape, const Raster& raster,
               std::size_t view, Visibility& visibility) {
  if (raster.depth.cols < 2 || raster.depth.rows < 2) return;
  parallel_for(
      images.size(),
      [&](std::size_t v) {
        if (is_seen(images[v], shape.normals[v], raster)) visibility.set_seen(v, view);
      },
      kPointGrain);
}

}  // namespace axial::refine
