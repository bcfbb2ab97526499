// SPDX-License-Identifier: GPL-3.0-or-later
#include "labels/posed_rays.h"

#include <variant>

namespace axial::labels {

PosedRays::PosedRays(const geometry::PosedCamera& posed)
    : posed_(posed), camera_(make_camera<double>(posed.camera)) {}

bool PosedRays::is_in_photograph(const Eigen::Vector2d& pixel) const {
  return geometry::is_in_image(posed_.camera, pixel, -0.5);
}

std::optional<Sight> PosedRays::sight(const Eigen::Vector2d& pixel) const {
  return std::visit(
      [&](const auto& camera) -> std::optional<Sight> {
        const Sight sight{posed_.pose.to_world(camera.exit_point(pixel)),
                          posed_.pose.rotation.transpose() * camera.ray(pixel).direction};
        if (!sight.from.allFinite() || !sight.direction.allFinite()) return std::nullopt;
        return sight;
      },
      camera_);
}

std::optional<Eigen::Vector2d> PosedRays::pixel_of(const Eigen::Vector3d& place) const {
  return std::visit(
      [&](const auto& camera) -> std::optional<Eigen::Vector2d> {
        const auto image = camera.project(posed_.pose.to_camera(place));
        if (!image.visible) return std::nullopt;
        return image.pixel;
      },
      camera_);
}

}  // namespace axial::labels
