// SPDX-License-Identifier: GPL-3.0-or-later
#include "point_source.h"

#include <algorithm>

#include "base/error.h"
#include "base/log.h"
#include "io/ply.h"

namespace densify {
namespace {

axial::SparsePoint sparse_point(const axial::PointCloud& cloud, std::size_t i,
                                std::size_t image_count, const std::string& file) {
  axial::SparsePoint point;
  point.position = cloud.positions[i];
  if (!point.position.allFinite()) axial::fail("{}: point {} is not finite", file, i);
  for (std::size_t k = cloud.view_begin[i]; k < cloud.view_begin[i + 1]; ++k) {
    const std::uint32_t image = cloud.view_images[k];
    if (image >= image_count)
      axial::fail("{}: point {} is seen by image {}, but the scene has {}", file, i, image,
                  image_count);
    point.views.push_back({image, cloud.view_weights.empty() ? 0.0f : cloud.view_weights[k]});
  }
  std::ranges::stable_sort(point.views, {}, &axial::SparseView::image);
  return point;
}

}  // namespace

void use_point_cloud(axial::Scene& scene, const std::filesystem::path& ply) {
  const std::string file = ply.string();
  axial::PointCloud cloud = axial::io::read_cloud_ply(ply);
  if (cloud.view_begin.empty())
    axial::fail("{}: has no view_indices, which say what images see a point", file);
  scene.points.clear();
  scene.points.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    scene.points.push_back(sparse_point(cloud, i, scene.images.size(), file));
  scene.point_normals = std::move(cloud.normals);
  scene.point_colors = std::move(cloud.colors);
  axial::log_info("{}: {} points in place of the scene's", file, scene.points.size());
}

}  // namespace densify
