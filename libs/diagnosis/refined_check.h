// SPDX-License-Identifier: GPL-3.0-or-later
// Checks, after refractive bundle adjustment, whether the photographs contradict the stated numbers
// of the housing: numbers that were adjusted, and numbers that were taken as known.
#pragma once

#include <optional>
#include <vector>

#include "pose/bundle/adjust_options.h"
#include "pose/bundle/housing_numbers.h"

namespace axial::diagnosis {

// The free numbers that differ from their measured values by more than three of their standard
// deviations before the adjustment (HousingNumber::sigma_before).
std::vector<pose::HousingNumber> moved_numbers(const pose::Bundle& refined,
                                               const pose::AdjustOptions& options);

// The effect of adjusting one number of the housing that was taken as known.
struct FreedNumber {
  pose::HousingNumber number;            // `before`: as stated; `now`: as adjusted
  double rms_stated = 0, rms_found = 0;  // RMS reprojection errors with these values [px]
  // About |change| in standard deviations: the square root of the decrease of the sum of squared
  // errors, divided by observed_pixel_sigma() after the adjustment.
  double deviations = 0;
  // The change of the scene, the larger of two: the RMS of the movements of the points after their
  // best similarity, divided by their median distance from the cameras, and the RMS of the relative
  // changes of the distances between cameras and points, at the same distances between cameras.
  double effect = 0;
};

// Frees, in turn, the groups of numbers of groups_to_free() (hypotheses.h): the index of the water,
// the normal and the distance of flat ports or the centre of domes, and the focal length. Groups
// with a number that `options` leaves free are skipped. Of `options`, only the free numbers and
// `poses_known` are used. If the cameras have different numbers, values are those of the first
// camera of the sample below. Returns the number with the smallest RMS error after the adjustment.
// If several numbers were freed together, the result is the number that changed most.
//
// A number counts only if its change is significant and matters: if FreedNumber::deviations is
// above 4, and FreedNumber::effect is above 0.001. The RMS error itself does not count. Poses can
// hide most of a wrong number in it, but not the wrong shape of the scene.
//
// Each adjustment uses at most 40 images and 2,000 points of the refined bundle and runs for at
// most 20 iterations. The scale of the model stays nearly constant. A wrong port distance is
// therefore found only if the scale was given. If refraction alone determined the scale, the scale
// has already adapted to the wrong distance.
//
// Returns nothing if the stated numbers fit, if fewer than 3 images or 20 points are left, if the
// ports are neither all flat nor all domes, or if an adjustment fails.
std::optional<FreedNumber> number_that_does_not_fit(const pose::Bundle& refined,
                                                    const pose::AdjustOptions& options);

}  // namespace axial::diagnosis
