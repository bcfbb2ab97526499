// SPDX-License-Identifier: GPL-3.0-or-later
// Checks, after refractive bundle adjustment, whether other numbers of the housing would fit the
// photographs better than the stated numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/setting_names.h"
#include "pose/refine.h"

namespace axial::pose {

// The effect of adjusting one number of the housing that was taken as known.
struct FreedNumber {
  std::string name, unit;                // as in FreeValue (free_numbers.h)
  double stated = 0, found = 0;          // the value before and after it was adjusted [unit]
  double rms_stated = 0, rms_found = 0;  // RMS reprojection errors with these values [px]
  // About |found - stated| in standard deviations: the square root of the decrease of the sum of
  // squared errors, divided by observed_pixel_sigma() after the adjustment.
  double deviations = 0;
  // The change of the scene, the larger of two: the RMS of the movements of the points after their
  // best similarity, divided by their median distance from the cameras, and the RMS of the relative
  // changes of the distances between cameras and points, at the same distances between cameras.
  double effect = 0;
};

// Frees, in turn, the index of the water, the normal and the distance of flat ports or the centre
// of domes, and the focal length. Numbers that `options` leaves free are skipped. Of `options`,
// only the free numbers and `poses_known` are used. If the cameras have different numbers, values
// are those of the first camera of the sample below. The numbers of a normal or of a centre are
// freed together. Returns the number with the smallest RMS error after the adjustment. If several
// numbers were freed together, the result is the number that changed most.
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
std::optional<FreedNumber> number_that_does_not_fit(const Bundle& refined,
                                                    const AdjustOptions& options);

// Returns the warning, one line, that names the number `freed` and its two values. `scale_sigma`:
// Uncertainty::scale_sigma, the relative standard deviation of lengths. If it is 0 or infinite, the
// warning does not mention lengths. Otherwise it says that lengths have a larger error than
// `scale_sigma`. `name_of` gives the name of the setting "refine", the list of numbers to adjust.
std::string warning_of(const FreedNumber& freed, double scale_sigma,
                       SettingNames name_of = own_name);

// Returns one line for each reason (errors, weak_images and weak_points of DropCounts) for which
// refine() dropped more than a quarter of the observations. `limits` are the limits that refine()
// used. Observations that repeat a point in an image are not counted. Only the line about large
// errors asks the user to check the housing, because the other reasons (few observations in an
// image, narrow angles) are properties of the survey.
std::vector<std::string> dropped_lines(const RefineReport& report, const TrackLimits& limits);

}  // namespace axial::pose
