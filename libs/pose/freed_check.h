// SPDX-License-Identifier: GPL-3.0-or-later
// After refractive bundle adjustment: would other numbers of the housing fit the photographs better
// than the stated numbers?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/setting_names.h"
#include "pose/refine.h"

namespace axial::pose {

// The effect of adjusting one number of the housing that was taken as known.
struct FreedNumber {
  std::string name, unit;
  double stated = 0, found = 0;          // [unit]
  double rms_stated = 0, rms_found = 0;  // [px]
  double deviations = 0;                 // |found - stated| in standard deviations
};

// Of the numbers of lens and port that `options` does not leave free, the one that lowers the RMS
// error most when it is adjusted. Only a decrease by 7 % or more, and by 0.02 px or more, counts: a
// good lens calibration leaves smaller errors. Adjusts a bounded part of the refined bundle (40
// images, 600 points) for up to 20 iterations for each number, with the model's lengths held.
//
// A wrong port distance is found only if the scale was given. If refraction alone determined the
// scale, poses at another scale fit as well.
//
// Empty if the stated numbers fit, if the bundle is too small, if its ports are not all flat or all
// domes, or if an adjustment fails.
std::optional<FreedNumber> number_that_does_not_fit(const Bundle& refined,
                                                    const AdjustOptions& options);

// The warning that names the number. `scale_sigma`: the relative standard deviation of lengths that
// the adjustment reports; infinite if it reports none. `name_of` names the setting "refine", the
// list of numbers to adjust.
std::string warning_of(const FreedNumber& freed, double scale_sigma,
                       SettingNames name_of = own_name);

// One line for each reason that dropped more than a quarter of the observations (observations that
// repeat a point in an image do not count). Only large errors question the housing; few
// observations in an image, or narrow angles, are properties of the survey.
std::vector<std::string> dropped_lines(const RefineReport& report, const TrackLimits& limits);

}  // namespace axial::pose
