// SPDX-License-Identifier: GPL-3.0-or-later
// Rigs in bundle adjustment: cameras that are mounted together and take photographs at the same
// time. A stated distance between two cameras of a rig gives the model its scale.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "axial/scene.h"

namespace axial::pose {

// Standard deviations of the pose of a camera in its rig within one frame: small movements of the
// cameras against each other, and times of exposure that differ a little. Errors that all frames
// share belong to RigCamera::sigma_translation and RigCamera::sigma_rotation.
inline constexpr double kFrameTranslation = 0.0002;                // [m]
inline constexpr double kFrameRotation = 0.02 * 3.14159265 / 180;  // [rad]
// Standard deviations of a stated pose whose file states none.
inline constexpr double kStatedTranslation = 0.0002;                // [m]
inline constexpr double kStatedRotation = 0.02 * 3.14159265 / 180;  // [rad]

// A camera of a rig. The frame of the rig is that of its reference camera.
struct RigCamera {
  std::string name;
  // fixed: `stated` is exact. stated: it has standard deviations. free: it is not known.
  enum class Known { fixed, stated, free } known = Known::free;
  // From the frame of the rig to that of the camera [m]: as stated (not used if `free`), and the
  // present value.
  Pose stated, now;
  // Standard deviations of `stated` per axis, above 0. Used if `known` is `stated`.
  double sigma_translation = kStatedTranslation;  // [m]
  double sigma_rotation = kStatedRotation;        // [rad]
  // The camera takes its photographs this much later than the reference camera, in the unit of
  // RigFrame::time. adjust() takes this number as known.
  double delay = 0;

  bool is_metric() const { return known != Known::free; }
};

// The photographs that a rig takes at one time: at most one of each camera.
struct RigFrame {
  struct Image {
    std::size_t camera = 0;  // index into Rig::cameras
    std::size_t image = 0;   // index into Bundle::images
  };
  std::vector<Image> images;
  double time = 0;  // [s], or without known times the number of the frame in their order
};

struct Rig {
  std::vector<RigCamera> cameras;  // the first camera is the reference camera, and is `fixed`
  std::vector<RigFrame> frames;    // in ascending order of their times
  bool has_seconds = false;        // false: RigFrame::time counts frames
};

// Standard deviations of the pose of a camera in its rig.
struct RigSigma {
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     // [rad]
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  // [m]
};

}  // namespace axial::pose
