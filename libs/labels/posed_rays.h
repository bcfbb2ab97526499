// SPDX-License-Identifier: GPL-3.0-or-later
// The exact rays of a photograph in the frame of the mesh.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "geometry/posed_camera.h"
#include "scene/camera_model.h"

namespace axial::labels {

// The path of light in the water (in air without a port), from where it leaves the port.
struct Sight {
  Eigen::Vector3d from, direction;  // [frame of the mesh]; the direction has length 1
};

class PosedRays {
 public:
  explicit PosedRays(const geometry::PosedCamera& posed);

  const geometry::PosedCamera& posed() const { return posed_; }

  // Whether a pixel lies in the photograph, with the whole area of its outermost pixels.
  bool is_in_photograph(const Eigen::Vector2d& pixel) const;

  // Nothing if no light reaches the pixel.
  std::optional<Sight> sight(const Eigen::Vector2d& pixel) const;

  // The pixel that sees a place, in the photograph or beside it. Nothing if the place is outside
  // the field of the camera.
  std::optional<Eigen::Vector2d> pixel_of(const Eigen::Vector3d& place) const;

 private:
  geometry::PosedCamera posed_;
  CameraVariant<double> camera_;
};

}  // namespace axial::labels
