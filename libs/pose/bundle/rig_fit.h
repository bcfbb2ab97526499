// SPDX-License-Identifier: GPL-3.0-or-later
// How the poses of a bundle fit its rigs.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "pose/bundle/bundle.h"

namespace axial::pose {

// Removes the photographs without observations from the frames.
void leave_out_unobserved(Bundle& bundle);

// The pose of the camera of `image` in the frame of the camera of `reference`.
Pose relative_pose(const Pose& image, const Pose& reference);

// The factor that scales the bundle to metres: the median, over all pairs of cameras of a frame
// whose poses are fixed or stated, of the stated distance divided by the distance in the bundle. 0
// if there is no such pair.
double scale_by_rigs(const Bundle& bundle);

// Sets RigCamera::now: to `stated`, or for free cameras to the pose in the frame that is nearest to
// the medians over all frames. Cameras without a frame in common with the reference camera keep
// their values.
void start_rigs(Bundle& bundle);

// The velocity of the rig in each frame [m per unit of time], in the frame of the reference camera,
// from the frame before and the frame after it, or from one of them. Empty for frames without a
// photograph of the reference camera, and if both neighbours are more than 2.5 times as far away as
// usual.
std::vector<std::optional<Eigen::Vector3d>> rig_velocities(const Bundle& bundle, const Rig& rig);

// How the poses of one camera fit its rig.
struct RigFit {
  std::size_t frames = 0;  // with photographs of this camera and of the reference camera
  // The frames that deviate by more than 12 standard deviations (kFrameTranslation and
  // kFrameRotation) and five times the median, as indices into Rig::frames: probably the
  // photographs were taken at different times. They do not count in the two numbers below.
  std::vector<std::size_t> wrong;
  double translation_rms = 0;  // of the deviations from RigCamera::now and its delay [m]
  double rotation_rms = 0;     // [rad]
  double speed = 0;            // median speed of the rig [m per unit of time]; 0: not known
  // The delay that fits the deviations along the velocity, with its standard deviation. Infinite:
  // nothing determines it.
  double delay = 0, delay_sigma = 0;  // in the unit of RigFrame::time

  // The delay is more than three standard deviations, and moves the camera by more than 0.5 mm.
  bool is_late() const;
};

// The fit of the camera with the index `camera`, not the reference camera. The delay is found by
// robust least squares of the deviations from the stated pose, together with a constant deviation,
// which has the standard deviations of the stated pose. Along the base, and for free cameras, the
// constant is not known, because a wrong scale or pose looks the same.
RigFit fit_of(const Bundle& bundle, const Rig& rig, std::size_t camera);

// Sets RigCamera::delay of all cameras of the bundle where RigFit::is_late() holds, and 0
// elsewhere. The rig pulls the photographs towards the delay that adjust() knew, so that only a
// part of an error of the delay is found: adjust again while the result is true. It is true if a
// delay changed by more than 1/200.
bool set_delays(Bundle& bundle);

}  // namespace axial::pose
