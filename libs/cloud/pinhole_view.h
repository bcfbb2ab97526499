// SPDX-License-Identifier: GPL-3.0-or-later
// A pinhole camera that stands for a camera behind a port, or with a distorted lens.
#pragma once

#include <Eigen/Core>

#include "scene/camera_model.h"
#include "scene/pose.h"

namespace axial::cloud {

struct PinholeView {
  CameraModel camera;  // no port, no distortion
  // The pinhole in the frame of the camera that it stands for; the axes of both are parallel [m].
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  bool whole = true;  // it shows all that the other camera sees

  // The same view with an image of another size.
  PinholeView resized(int width, int height) const;

  // The pinhole's pose, for the pose of the camera that it stands for.
  Pose pose(const Pose& of_camera) const {
    return {of_camera.rotation, of_camera.to_world(centre)};
  }

  // The point that `pixel` sees at `z_depth` from the pinhole, in the other camera's frame.
  Eigen::Vector3d point(const Eigen::Vector2d& pixel, double z_depth) const {
    return centre + z_depth * camera.lens.bearing(pixel);
  }
};

// The pinhole for `model`, whose scene lies at distances (lambda) of `near` to `far`, 0 < near <=
// far. Its centre is the point nearest to the rays of all pixels (least squares), so that it sees
// past the same edges, and a pixel depends little on depth. In the image's centre its pixels are as
// large as the model's; its image is as large as it takes to show all that the model sees, but at
// most 1.4 times as wide and as high as the model's, and at most 70 degrees from its axis. A
// pinhole is its own.
PinholeView pinhole_for(const CameraModel& model, double near, double far);

}  // namespace axial::cloud
