// SPDX-License-Identifier: GPL-3.0-or-later
// The likely cause of a pattern of reprojection errors: the number of a port or a lens whose change
// would explain the pattern best.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/residual_pattern.h"
#include "diagnosis/residuals.h"
#include "pose/bundle/housing_numbers.h"

namespace axial::diagnosis {

inline constexpr std::size_t kAllCameras = ~std::size_t{0};

// A possible cause: numbers that are changed together.
struct Cause {
  std::size_t camera = 0;  // index into TrackedPhotographs::cameras, or kAllCameras
  std::string name;        // for example "normal of the port"
  // With the changes that fit the errors best (HousingNumber::change; exact for small changes) and
  // the standard deviations of the changes (sigma).
  std::vector<pose::HousingNumber> numbers;
  double share = 0;  // of the squared systematic errors that the change explains, at most 1
};

struct CauseLimits {
  std::size_t images = 120, observations = 60000;  // of the sample
  std::size_t cameras = 4;                         // candidates, in the order of `suspects`
};

// The possible causes of the errors, best first. Candidates are the numbers of the cameras
// `suspects` (indices): normal, distance, thickness, and index of the water of a flat port; centre,
// radius, thickness and index of a dome; focal length and principal point of the lens. A camera
// without a port also has the candidate "a port that is not modelled", together with the focal
// length, because the calibration of a lens under water adapts the focal length to the port. The
// index of the water is also tried for all cameras with one value together.
//
// Each candidate is judged by one linear step. Poses and points are free in this step, except for
// the scale (remove_poses_and_points()). A candidate is left out if its numbers would become
// impossible, such as a clearly negative distance. A candidate with several numbers stands behind
// its single numbers if it explains hardly more. A sample of images around the image with the most
// observations is used. Empty if the sample has fewer than 3 images or 20 points, or no systematic
// errors.
std::vector<Cause> residual_causes(const TrackedPhotographs& photographs,
                                   std::span<const Eigen::Vector2d> freed,
                                   std::span<const std::size_t> suspects,
                                   const CauseLimits& limits = {});

}  // namespace axial::diagnosis
