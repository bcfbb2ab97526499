// SPDX-License-Identifier: GPL-3.0-or-later
// A pinhole camera that replaces a camera behind a port or with a distorted lens.
#pragma once

#include <Eigen/Core>

#include "scene/camera_model.h"
#include "scene/pose.h"

namespace axial::cloud {

struct PinholeView {
  CameraModel camera;  // no port, no distortion
  // The pinhole's centre [m] in the frame of the camera that it replaces. The axes of both cameras
  // are parallel.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  bool whole = true;  // the pinhole's image shows everything that the other camera sees

  // The same view with an image of another size [px].
  PinholeView resized(int width, int height) const;

  // The pinhole's pose. `of_camera`: the pose of the camera that it replaces.
  Pose pose(const Pose& of_camera) const {
    return {of_camera.rotation, of_camera.to_world(centre)};
  }

  // The point that `pixel` of the pinhole sees at `z_depth` [m] from the pinhole, in the frame of
  // the camera that it replaces.
  Eigen::Vector3d point(const Eigen::Vector2d& pixel, double z_depth) const {
    return centre + z_depth * camera.lens.bearing(pixel);
  }
};

// The pinhole that replaces `model`, for a scene at distances (lambda) from `near` to `far` [m].
// Precondition: 0 < near <= far. Its centre is the point nearest to the rays of all pixels (least
// squares). So almost the same surfaces are hidden from both cameras, and the correspondence of
// their pixels depends little on depth. In the centre of the image both have pixels of the same
// angular size. The pinhole's image is large enough to show everything that `model` sees, but at
// most 1.4 times as wide and as high as the image of `model`, and reaches at most 70 degrees from
// the axis. For a model that is a pinhole already, the result is the same pinhole.
PinholeView pinhole_for(const CameraModel& model, double near, double far);

}  // namespace axial::cloud
