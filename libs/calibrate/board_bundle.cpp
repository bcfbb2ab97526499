// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibrate/board_bundle.h"

#include "io/colmap/colmap_lens.h"
#include "lens/lens.h"

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
  const lens::Lens in_air = io::lens_of(bundle.lenses[0]);
  const CameraModel now = bundle.bundle.cameras[0].now();
  const auto camera = make_camera<double>(now);
  std::vector<Corner> seen;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto image =
        std::visit([&](const auto& c) { return c.project(pose.to_camera(corners[i])); }, camera);
    if (!image.visible) continue;
    const Eigen::Vector3d bearing = now.lens.bearing(image.pixel);
    const Eigen::Vector2d pixel = image_direction(in_air, bearing.x(), bearing.y());
    const bool inside = pixel.x() >= 1 && pixel.y() >= 1 && pixel.x() <= in_air.width - 2.0 &&
                        pixel.y() <= in_air.height - 2.0;
    // A distortion model may also fold distant directions back into the image: they are not
    // visible.
    if (inside && direction_at(in_air, pixel)) seen.push_back({i, pixel});
  }
  return seen;
}

}  // namespace axial::calibrate
