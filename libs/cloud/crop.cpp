// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/crop.h"

namespace axial::cloud {
namespace {

template <class T>
void keep(std::vector<T>& values, const std::vector<std::size_t>& kept) {
  if (values.empty()) return;
  for (std::size_t i = 0; i < kept.size(); ++i) values[i] = values[kept[i]];
  values.resize(kept.size());
}

void keep_views(PointCloud& cloud, const std::vector<std::size_t>& kept) {
  if (cloud.view_begin.empty()) return;
  std::size_t end = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const std::size_t begin = cloud.view_begin[kept[i]], last = cloud.view_begin[kept[i] + 1];
    cloud.view_begin[i] = end;
    for (std::size_t k = begin; k < last; ++k, ++end) {
      cloud.view_images[end] = cloud.view_images[k];
      if (!cloud.view_weights.empty()) cloud.view_weights[end] = cloud.view_weights[k];
    }
  }
  cloud.view_begin.resize(kept.size() + 1);
  cloud.view_begin.back() = end;
  cloud.view_images.resize(end);
  if (!cloud.view_weights.empty()) cloud.view_weights.resize(end);
}

template <class Box>
std::size_t keep_inside(PointCloud& cloud, const Box& box) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (box.contains(cloud.positions[i].cast<double>())) kept.push_back(i);
  }
  const std::size_t removed = cloud.size() - kept.size();
  keep_views(cloud, kept);
  keep(cloud.positions, kept);
  keep(cloud.normals, kept);
  keep(cloud.colors, kept);
  keep(cloud.errors, kept);
  keep(cloud.confidences, kept);
  return removed;
}

}  // namespace

std::size_t crop(PointCloud& cloud, const OrientedBox& region) {
  return keep_inside(cloud, region);
}

std::size_t crop(PointCloud& cloud, const Tile& tile) {
  return keep_inside(cloud, tile);
}

}  // namespace axial::cloud
