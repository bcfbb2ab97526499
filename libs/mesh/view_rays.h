// SPDX-License-Identifier: GPL-3.0-or-later
// The rays between points of a scene and its cameras.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "scene/any_camera.h"
#include "scene/scene.h"

namespace axial::mesh {

// The cameras of a scene, with methods for the rays from points to cameras. `image` is an index
// into Scene::images. The object keeps a copy of poses and cameras.
class ViewRays {
 public:
  explicit ViewRays(const Scene& scene);

  // The derivative of the image position of `point` in `image` by the position of `point` [px/m];
  // rows: x and y of the pixel. `point` is in the frame of the scene. Zero if the camera does not
  // see the point (its projection is not visible). Precondition: the image is calibrated.
  Eigen::Matrix<float, 2, 3> pixel_motion(std::uint32_t image, const Eigen::Vector3f& point) const;

  // The end of the straight part of the ray from `point` to the camera [m]: the place where the ray
  // enters the port, or in air the centre of projection. `point` and the result are in the frame of
  // the scene. Empty if the camera does not see the point (its projection is not visible).
  // Precondition: the image is calibrated.
  std::optional<Eigen::Vector3d> exit_point(std::uint32_t image,
                                            const Eigen::Vector3d& point) const;

 private:
  std::vector<Pose> poses_;
  std::vector<AnyCamera<double>> cameras_;
};

}  // namespace axial::mesh
