// SPDX-License-Identifier: GPL-3.0-or-later
// A simulated survey by a rig of two cameras, each behind its own flat port, which moves over rough
// ground at a constant speed.
#pragma once

#include "pose/survey.h"

namespace axial::pose::testing {

struct RigSurveyOptions {
  Eigen::Vector3d base{0, 0.2,
                       0};  // from the left to the right camera, in the left one's frame [m]
  double turn = 3;          // of the right camera about its x axis [degrees]
  int frames = 12;
  int points = 300;
  double speed = 0.3;     // along x [m/s]
  double interval = 0.4;  // between frames [s]
  double delay = 0;       // of the right camera [s]
  double sway = 1;        // 0: the rig moves along a line and does not turn
  double distance = 1;    // to the ground [m]
  double noise = 0;       // standard deviation per axis [px]
  unsigned seed = 1;
};

// The pose of the right camera in the frame of the left one.
Pose right_in_rig(const RigSurveyOptions& options);

// The survey, without rigs: left/frame00.jpg, right/frame00.jpg, left/frame01.jpg, ...
Bundle rig_survey(const RigSurveyOptions& options);

// The rig of rig_survey() with the true pose of the right camera, and times in seconds.
Rig true_rig(const RigSurveyOptions& options, RigCamera::Known known);

}  // namespace axial::pose::testing
