// SPDX-License-Identifier: GPL-3.0-or-later
// A pinhole camera that replaces a camera behind a port or with a distorted lens.
#pragma once

#include <Eigen/Core>

#include "axial/scene.h"
#include "scene/camera_model.h"

namespace axial::cloud {

// The pinhole that replaces another camera.
struct PinholeView {
  CameraModel camera;  // no port, no distortion
  // The pinhole's centre [m] in the frame of the camera that the pinhole replaces. The axes of both
  // cameras are parallel.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  bool whole = true;  // the pinhole's image shows everything that the other camera sees

  // The same view with an image of another size [px]. The field of view stays.
  PinholeView resized(int width, int height) const;

  // The pose of the pinhole. `of_camera`: the pose of the camera that the pinhole replaces.
  Pose pose(const Pose& of_camera) const {
    return {of_camera.rotation, of_camera.to_world(centre)};
  }

  // The point [m] that `pixel` of the pinhole sees at `z_depth` [m] from the pinhole. The point is
  // in the frame of the camera that the pinhole replaces.
  Eigen::Vector3d point(const Eigen::Vector2d& pixel, double z_depth) const {
    return centre + z_depth * camera.lens.bearing(pixel);
  }
};

// Returns the pinhole that replaces `model`, for surfaces at distances from `near` to `far` [m]
// along the rays of `model`. Precondition: 0 < near <= far. If `model` is a pinhole already, the
// result is the same pinhole. Otherwise:
//
// * The centre of the pinhole is the point nearest to the rays of the whole image (least squares).
//   So almost the same surfaces are hidden from both cameras, and the correspondence of their
//   pixels depends little on depth.
// * In the centre of the image the pixels of both cameras have the same angular size.
// * The image is large enough to show everything that `model` sees, with two exceptions: rays more
//   than 70 degrees from the axis, and rays beyond the largest image. Let w x h be the image size
//   of `model`. The largest image reaches 0.7 w to the left and right of the point that the centre
//   of the image of `model` sees, and 0.7 h up and down. If rays are left out, `whole` is false.
PinholeView pinhole_for(const CameraModel& model, double near, double far);

}  // namespace axial::cloud
