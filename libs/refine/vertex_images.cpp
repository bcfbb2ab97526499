// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/vertex_images.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <variant>

#include "base/parallel.h"
#include "scene/camera_model.h"

namespace axial::refine {

Eigen::Vector3f VertexImage::ray() const {
  const Eigen::Vector3f right = by_point.row(0), down = by_point.row(1);
  return right.cross(down).normalized();
}

namespace {

template <class Camera>
void project_all(const Camera& camera, const PosedCamera& view,
                 std::span<const Eigen::Vector3f> vertices, std::vector<VertexImage>& images) {
  const Eigen::Matrix3f rotation = view.pose.rotation.cast<float>();
  const float margin = static_cast<float>(std::max(view.camera.width, view.camera.height)) / 8;
  const float right = static_cast<float>(view.camera.width - 1) + margin;
  const float bottom = static_cast<float>(view.camera.height - 1) + margin;
  parallel_for(
      vertices.size(),
      [&](std::size_t v) {
        const Eigen::Vector3f point = view.pose.to_camera(vertices[v].cast<double>()).cast<float>();
        if (!(point.z() > 0)) return;
        refractive::Matrix23<float> jacobian;
        Eigen::Vector3f origin;
        const auto image = camera.project(point, &jacobian, &origin);
        if (!image.visible) return;
        const float x = image.pixel.x(), y = image.pixel.y();
        if (!(x >= -margin && y >= -margin && x <= right && y <= bottom)) return;
        images[v] = {x, y, (point - origin).norm(), jacobian * rotation};
      },
      kPointGrain);
}

}  // namespace

std::vector<VertexImage> vertex_images(std::span<const Eigen::Vector3f> vertices,
                                       const PosedCamera& view) {
  std::vector<VertexImage> images(vertices.size());
  std::visit([&](const auto& camera) { project_all(camera, view, vertices, images); },
             make_camera<float>(view.camera));
  return images;
}

}  // namespace axial::refine
