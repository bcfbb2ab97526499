// SPDX-License-Identifier: GPL-3.0-or-later
// Coded targets in bundle adjustment: points whose images were measured by themselves.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pose/bundle/bundle.h"
#include "pose/bundle/target.h"

namespace axial::pose {

// Adds a point for each target with two or more images, and an observation for each image. Targets
// with fewer images get no point, and `source` 0. The start of a point is where its rays meet at
// the present poses; where they do not meet, the mean of all points.
void add_targets(Bundle& bundle, std::span<Target> targets);

// Sets the pixels of the observations of targets. The centre of a dot's ellipse is not the image of
// the dot's centre, and diagonals meet in the image of the centre of a square only if lines are
// imaged as lines. Each pixel is `TargetImage::pixel` plus the difference of the two
// (target_shape.h) at the present poses, cameras and points. Then sets
// Observation::target_sigma: the variance is that of TargetImage::sigma plus one variance of all
// targets, which stands for errors of the lens and of the plates. Its value is the smallest that
// explains the median reprojection error of targets.
void correct_targets(Bundle& bundle, std::span<const Target> targets);

// A target whose photographs show it at two places: two plates with one code, or a plate that was
// moved during the survey.
struct DoubleTarget {
  std::size_t target = 0;             // index into the targets
  std::size_t first = 0, second = 0;  // numbers of photographs
  double distance = 0;                // between the places [m]
};

// Finds targets of which at least two photographs agree with one place, and at least two others
// with a place elsewhere. Photographs agree with a place if the reprojection error is at most
// `max_error` [px], and a place is elsewhere if its photographs show the two places at least three
// times as far apart. Precondition: the bundle is in metres.
std::vector<DoubleTarget> double_targets(const Bundle& bundle, std::span<const Target> targets,
                                         double max_error);

// Removes the points of the targets and their observations.
void drop_targets(Bundle& bundle);

}  // namespace axial::pose
