// SPDX-License-Identifier: GPL-3.0-or-later
// The noise of the difference of two surveys, from the ground that did not change.
#pragma once

#include <opencv2/core.hpp>

#include "axial/compare.h"

namespace axial::compare {

// Estimates the noise. `difference`: later minus earlier height [m]; NaN where they are not
// compared. `steepness`: sqrt(1 + slope^2) of each of these pixels. `least`: the smallest standard
// deviation to return, above 0 [m].
//
// The typical standard deviation is the robust one of the differences, divided by the steepness.
// Differences farther from the median than three of these standard deviations are left out, and so
// on until nothing changes. So changed ground does not count as noise if it is less than half of
// the map. The deviation of a cell follows from the differences of its pixels from the mean of the
// pixels 4 to the left, to the right, above and below, in proportion to those of the whole map. So
// ground that changed smoothly has the noise of its surface. It is from 0.5 to 4 times the
// typical one. A cell with fewer than 64 such pixels has the typical one.
Noise estimate_noise(const cv::Mat1f& difference, const cv::Mat1f& steepness, double least);

// The noise with the standard deviation `sigma` [m] on level ground everywhere. The correlation is
// that of the differences.
Noise given_noise(const cv::Mat1f& difference, const cv::Mat1f& steepness, double sigma);

}  // namespace axial::compare
