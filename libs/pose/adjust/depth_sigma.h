// SPDX-License-Identifier: GPL-3.0-or-later
// The uncertainty of the distances between cameras and points.
#pragma once

#include "base/context.h"
#include "pose/bundle/adjust_options.h"

namespace axial::pose {

// Returns the standard deviation of the distances from the cameras to the points, divided by the
// distances, that the errors of the free numbers of lens and port cause. The places of the cameras
// relative to each other are given: wrong numbers move all points nearer to the cameras or farther
// away from them, and a length between cameras does not show it.
//
// `bundle` and `options`: as for covariance_of_numbers(). For each principal direction of the
// covariance of the numbers, the numbers change by one standard deviation, and the bundle is
// adjusted again with these numbers, with at most 1500 points or ten for each image. The result is
// the root of the sum of the squared median changes of the distances, after the similarity of the
// camera centres. 0 if there are no free numbers. Infinite if nothing determines a
// free number, if numbers that differ by one standard
// deviation have no solution, and with fewer than three images with observations.
double depth_sigma(const Bundle& bundle, const AdjustOptions& options, const Context& context = {});

}  // namespace axial::pose
