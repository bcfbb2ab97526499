// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/point_cloud.h"

namespace axial {

PointCloud cloud_of(const Scene& scene) {
  PointCloud cloud;
  cloud.view_begin.push_back(0);
  for (const SparsePoint& point : scene.points) {
    cloud.positions.push_back(point.position);
    for (const SparseView& view : point.views) {
      cloud.view_images.push_back(view.image);
      cloud.view_weights.push_back(view.confidence);
    }
    cloud.view_begin.push_back(cloud.view_images.size());
  }
  cloud.normals = scene.point_normals;
  cloud.colors = scene.point_colors;
  return cloud;
}

}  // namespace axial
