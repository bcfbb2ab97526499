// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/board_bundle.h"

namespace axial::calibrate {
namespace {

io::ColmapModel model_of(const io::ColmapCamera& lens, std::span<const View> views,
                         std::span<const Eigen::Vector3d> corners) {
  io::ColmapModel model;
  model.cameras = {lens};
  for (const Eigen::Vector3d& corner : corners)
    model.points.push_back({model.points.size(), corner, {}, 0, {}});
  for (const View& view : views) {
    io::ColmapImage image;
    image.id = static_cast<std::uint32_t>(model.images.size() + 1);
    image.camera = lens.id;
    image.name = view.image;
    for (const Corner& corner : view.corners) {
      model.points.at(corner.number)
          .track.push_back({image.id, static_cast<std::uint32_t>(image.points.size())});
      image.points.push_back({corner.pixel.x() + 0.5, corner.pixel.y() + 0.5, corner.number});
    }
    model.images.push_back(std::move(image));
  }
  return model;
}

}  // namespace

pose::ColmapBundle board_bundle(const io::ColmapCamera& lens, const refractive::Port<double>& port,
                                std::span<const View> views,
                                std::span<const Eigen::Vector3d> corners,
                                std::span<const Pose> poses) {
  pose::ColmapBundle result = pose::to_bundle(model_of(lens, views, corners), std::span(&lens, 1),
                                              io::housing_with(io::to_housing_port(port)));
  for (std::size_t i = 0; i < poses.size(); ++i) result.bundle.images[i].pose = poses[i];
  return result;
}

std::vector<Corner> photographed(const pose::ColmapBundle& bundle,
                                 std::span<const Eigen::Vector3d> corners, const Pose& pose) {
  const pose::HousedCamera now = bundle.bundle.cameras[0].now();
  const pose::PhotographCamera camera(now);
  std::vector<Corner> seen;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const pose::PhotographImage image = camera.image(pose.to_camera(corners[i]));
    if (!image.visible) continue;
    const Eigen::Vector2d& pixel = image.pixel;
    const bool inside = pixel.x() >= 1 && pixel.y() >= 1 && pixel.x() <= now.lens.width - 2.0 &&
                        pixel.y() <= now.lens.height - 2.0;
    if (inside) seen.push_back({i, pixel});
  }
  return seen;
}

}  // namespace axial::calibrate
