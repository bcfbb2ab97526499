// SPDX-License-Identifier: GPL-3.0-or-later
// A few sparse points of a scene, with the pixels at which its images see them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "scene/any_camera.h"
#include "scene/scene.h"

namespace axial {

// The exact cameras of the images of a scene, made when they are first needed.
class SceneCameras {
 public:
  // `scene` must outlive the object.
  explicit SceneCameras(const Scene& scene) : scene_(&scene) {}

  // The camera of a calibrated image.
  const AnyCamera<double>& of(std::uint32_t image);

  // The pixel at which an image sees a point [frame of the scene], at the resolution of
  // SceneImage::camera. Nothing if the image is not calibrated or does not see the point, or if the
  // pixel lies outside the image.
  std::optional<Eigen::Vector2d> pixel(std::uint32_t image, const Eigen::Vector3d& point);

 private:
  const Scene* scene_;
  std::map<std::uint32_t, AnyCamera<double>> cameras_;
};

// An image that sees a sparse point.
struct PlaceSight {
  std::uint32_t image = 0;                          // index into Scene::images
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  // of the point, by the exact camera
};

struct SparsePlace {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::vector<PlaceSight> sights;  // by ascending image, each image once, at least two
};

// Returns about `most` of the sparse points, spread evenly over their list. Points are left out
// that are not finite, or that fewer than two calibrated images see inside of their rectangles. At
// most `most_sights` sights of each point are taken, spread evenly.
std::vector<SparsePlace> spread_places(const Scene& scene, SceneCameras& cameras, std::size_t most,
                                       std::size_t most_sights);

// `count` indices, or all if there are fewer, spread evenly over 0 to `size` - 1, in ascending
// order.
std::vector<std::size_t> spread_indices(std::size_t size, std::size_t count);

}  // namespace axial
