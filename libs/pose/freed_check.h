// SPDX-License-Identifier: GPL-3.0-or-later
// After refractive bundle adjustment: do the photographs want another housing than the one given?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pose/refine.h"

namespace axial::pose {

// What one number of the housing, set free, does to the errors.
struct FreedNumber {
  std::string name, unit;
  double stated = 0, found = 0;          // [unit]
  double rms_stated = 0, rms_found = 0;  // [px]
  double deviations = 0;                 // how far the stated value is off, in standard deviations
};

// Of the numbers of lens and port that `options` does not leave free, the one that brings the RMS
// down most, by 7 % or more: less is within what a good lens calibration leaves. A bounded part of
// the refined bundle (40 images, 600 points) is adjusted for some iterations with each number free,
// the model's lengths held. So a distance that is wrong shows where the scale was given: where
// refraction alone told the scale, poses at another scale fit as well, and nothing can tell.
// Nothing where the stated numbers fit, or the bundle is too small to say.
std::optional<FreedNumber> number_that_does_not_fit(const Bundle& refined,
                                                    const AdjustOptions& options);

// The warning of it. `scale_sigma`: what the adjustment claims to know lengths to, relative;
// infinite if it claims nothing.
std::string warning_of(const FreedNumber& freed, double scale_sigma);

// Where a quarter of the observations or more were dropped: the reason of most. Only errors ask for
// the housing; few observations in an image, or narrow angles, are the survey's own.
std::vector<std::string> dropped_lines(const RefineReport& report, const TrackLimits& limits);

}  // namespace axial::pose
