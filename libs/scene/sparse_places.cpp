// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sparse_places.h"

namespace axial {

const AnyCamera<double>& SceneCameras::of(std::uint32_t image) {
  const auto found = cameras_.find(image);
  if (found != cameras_.end()) return found->second;
  return cameras_
      .emplace(image, AnyCamera<double>(make_camera<double>(scene_->images[image].camera)))
      .first->second;
}

std::optional<Eigen::Vector2d> SceneCameras::pixel(std::uint32_t image,
                                                   const Eigen::Vector3d& point) {
  if (image >= scene_->images.size()) return {};
  const SceneImage& seen_in = scene_->images[image];
  if (!seen_in.calibrated) return {};
  const auto projected = of(image).project(seen_in.pose.to_camera(point));
  const Eigen::Vector2d& pixel = projected.pixel;
  if (!projected.visible || !(pixel.minCoeff() >= -0.5) ||
      !(pixel.x() <= seen_in.camera.width - 0.5) || !(pixel.y() <= seen_in.camera.height - 0.5))
    return {};
  return pixel;
}

std::vector<std::size_t> spread_indices(std::size_t size, std::size_t count) {
  std::vector<std::size_t> indices;
  const std::size_t taken = std::min(size, count);
  for (std::size_t k = 0; k < taken; ++k)
    indices.push_back(static_cast<std::size_t>(
        (static_cast<double>(k) + 0.5) * static_cast<double>(size) / static_cast<double>(taken)));
  return indices;
}

std::vector<SparsePlace> spread_places(const Scene& scene, SceneCameras& cameras, std::size_t most,
                                       std::size_t most_sights) {
  std::vector<SparsePlace> places;
  for (const std::size_t i : spread_indices(scene.points.size(), most)) {
    const SparsePoint& point = scene.points[i];
    if (!point.position.allFinite()) continue;
    SparsePlace place{point.position.cast<double>(), {}};
    for (const std::size_t k : spread_indices(point.views.size(), most_sights)) {
      const std::uint32_t image = point.views[k].image;
      if (!place.sights.empty() && place.sights.back().image == image) continue;
      if (const auto pixel = cameras.pixel(image, place.position))
        place.sights.push_back({image, *pixel});
    }
    if (place.sights.size() >= 2) places.push_back(std::move(place));
  }
  return places;
}

}  // namespace axial
