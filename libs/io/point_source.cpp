// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/point_source.h"

#include <algorithm>

#include "base/error.h"
#include "base/log.h"
#include "io/ply.h"

namespace axial::io {
namespace {

SparsePoint sparse_point(const PointCloud& cloud, std::size_t i, std::size_t image_count,
                         const std::string& file) {
  SparsePoint point;
  point.position = cloud.positions[i];
  if (!point.position.allFinite()) fail("{}: point {} is not finite", file, i);
  for (std::size_t k = cloud.view_begin[i]; k < cloud.view_begin[i + 1]; ++k) {
    const std::uint32_t image = cloud.view_images[k];
    if (image >= image_count)
      fail("{}: point {} is seen by image {}, but the scene has {}", file, i, image, image_count);
    point.views.push_back({image, cloud.view_weights.empty() ? 0.0f : cloud.view_weights[k]});
  }
  std::ranges::stable_sort(point.views, {}, &SparseView::image);
  return point;
}

PointCloud read_into(const LocalFrame& frame, const std::filesystem::path& ply) {
  if (frame.is_world()) return read_cloud_ply(ply, frame);
  const PlyPlace place = ply_place(ply);
  const bool says_where = !place.frame.is_world();
  const Eigen::Vector3d& first = place.first_vertex;
  const bool is_local = !says_where && first.norm() < frame.to_local(first).norm();
  return is_local ? read_cloud_ply(ply) : read_cloud_ply(ply, frame);
}

}  // namespace

void use_point_cloud(Scene& scene, const LocalFrame& frame, const std::filesystem::path& ply) {
  const std::string file = ply.string();
  PointCloud cloud = read_into(frame, ply);
  if (cloud.view_begin.empty())
    fail("{}: has no view_indices, which say what images see a point", file);
  scene.points.clear();
  scene.points.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    scene.points.push_back(sparse_point(cloud, i, scene.images.size(), file));
  scene.point_normals = std::move(cloud.normals);
  scene.point_colors = std::move(cloud.colors);
  log_info("{}: {} points in place of the scene's", file, scene.points.size());
}

}  // namespace axial::io
