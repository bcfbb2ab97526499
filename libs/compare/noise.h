// SPDX-License-Identifier: GPL-3.0-or-later
// The noise of the difference of two surveys, from the ground that did not change.
#pragma once

#include <opencv2/core.hpp>

namespace axial::compare {

// The noise of the differences of heights. The standard deviation at a pixel is that of its cell
// times the steepness of the pixel, because a surface that is displaced along its normal changes
// its height by the displacement times the steepness.
struct Noise {
  int cell = 32;                   // side of a cell [px]
  cv::Mat1f cells;                 // standard deviation on level ground [m]: of each cell
  double typical = 0;              // the same for all of the map [m]
  double lowest = 0, highest = 0;  // of `cells` [m]
  // The standard deviation on level ground that the differences between pixels a few pixels apart
  // show [m]. Noise that is similar at neighbouring pixels has less of it than `typical`, and
  // changed ground much less.
  double local = 0;
  bool is_given = false;  // by the user, for all of the map
  // The variance of the mean of many pixels, times their number, divided by the variance of one
  // pixel. 1 if the pixels are independent.
  double correlation = 1;

  // The standard deviation of a pixel on level ground [m].
  float at(int y, int x) const { return cells(y / cell, x / cell); }
};

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
