// SPDX-License-Identifier: GPL-3.0-or-later
// The camera of bundle adjustment: the lens itself, with its distortion, behind a port. Its pixels
// are pixels of the photograph, with centres at integers. Points and rays are in metres in the
// camera frame.
#pragma once

#include <optional>

#include "lens/lens.h"
#include "scene/camera_model.h"

namespace axial::pose {

// The lens in air and the port, as data.
struct HousedCamera {
  lens::Lens lens;
  std::optional<refractive::Port<double>> port = {};  // empty: no port
  // The field of `lens` (lens/lens.h). It need not be computed anew if both focal lengths are
  // multiplied by one factor: field.reach stays exact, and field.corner becomes an estimate, which
  // only affects the speed.
  lens::Field field = field_of(lens);
};

// The image of a point.
struct PhotographImage {
  // True if the point has an image. False if no light from the point reaches the lens, if the
  // lens has no image of this light, or if the image lies outside the photograph widened by an
  // eighth of its longer side. If false, all other members are meaningless.
  bool visible = false;
  Eigen::Vector2d pixel;        // in the photograph
  Eigen::Vector2d tangents;     // (u, v) of the in-air direction (u, v, 1) of the light
  Eigen::Matrix2d by_tangents;  // d(pixel)/d(tangents) [px]
  refractive::Matrix23<double> tangents_by_point;  // d(tangents)/d(point) [1/m]
  Eigen::Vector3d origin;  // origin of the ray in water through the point [m]
};

// A HousedCamera that projects points and returns the rays of pixels.
class PhotographCamera {
 public:
  explicit PhotographCamera(HousedCamera camera);

  // The image of X [camera frame, m] by the exact projection, with derivatives.
  PhotographImage image(const Eigen::Vector3d& X) const;

  // The ray in water of `pixel`, in the camera frame [m]. Without a port, it is the ray in air.
  // Origin and direction are NaN if the pixel is the image of no direction.
  refractive::AxialRay<double> ray(const Eigen::Vector2d& pixel) const;

  // The principal point (cx, cy) of the lens [px].
  const Eigen::Vector2d& principal_point() const { return principal_point_; }

 private:
  HousedCamera camera_;
  TangentCamera inner_;
  refractive::WidenedImage<double> widened_;
  Eigen::Vector2d principal_point_;
};

}  // namespace axial::pose
