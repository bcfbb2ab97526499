// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/view_rays.h"

namespace axial::mesh {
namespace {

// Stands for the camera of an image without calibration, which no point names.
CameraModel any_model() {
  return {4, 4, {1, 1, 0, 0}, {}, {}};
}

}  // namespace

ViewRays::ViewRays(const Scene& scene) {
  for (const SceneImage& image : scene.images) {
    poses_.push_back(image.pose);
    cameras_.emplace_back(make_camera<double>(image.calibrated ? image.camera : any_model()));
  }
}

Eigen::Matrix<float, 2, 3> ViewRays::pixel_motion(std::uint32_t image,
                                                  const Eigen::Vector3f& point) const {
  Eigen::Matrix<double, 2, 3> by_point;
  const Pose& pose = poses_[image];
  if (!cameras_[image].project(pose.to_camera(point.cast<double>()), &by_point).visible)
    return Eigen::Matrix<float, 2, 3>::Zero();
  return (by_point * pose.rotation).cast<float>();
}

std::optional<Eigen::Vector3d> ViewRays::exit_point(std::uint32_t image,
                                                    const Eigen::Vector3d& point) const {
  const Pose& pose = poses_[image];
  const auto projection = cameras_[image].project(pose.to_camera(point));
  if (!projection.visible) return {};
  return pose.to_world(std::visit(
      [&](const auto& camera) -> Eigen::Vector3d { return camera.exit_point(projection.pixel); },
      cameras_[image].kind()));
}

}  // namespace axial::mesh
