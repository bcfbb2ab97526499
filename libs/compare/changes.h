// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the regions in which the difference of two surveys is significant, and their volumes.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "compare/registration.h"
#include "map/frame.h"

namespace axial::compare {

// The classes of the pixels.
inline constexpr std::uint8_t kUnchanged = 0, kGone = 1, kCame = 2, kNotCompared = 255;

struct ChangeOptions {
  // A region of change consists of adjacent pixels whose differences have the same sign and are
  // larger than `weak` standard deviations. At least `least_pixels` of them are larger than
  // `strong` standard deviations. Pixels that touch at a corner are adjacent. These are pixels that
  // both surveys see. Then unseen pixels are added that continue the region and whose differences
  // are at most twice the median of the region, if they are at most a quarter of its seen pixels.
  // Other unseen pixels are not compared.
  double strong = 3, weak = 1.5;
  int least_pixels = 8;
  // The volume of a region includes the differences, of either sign, of the pixels around it that
  // are in no region, up to this distance [px]: noise decides which pixels at the rim are larger
  // than `weak`, so that the differences in the region alone would be too large on average.
  int rim = 2;
};

// A volume between the surveys. `volume` and `sigma` are 0 or more.
struct Volume {
  double volume = 0, sigma = 0;  // [m^3]
  double area = 0;               // of the pixels in regions, without their rims [m^2]
};

struct Region {
  bool came = false;
  Volume size;
  double x = 0, y = 0;  // mean of the places of its pixels [map]
  double largest = 0;   // largest absolute difference [m]
};

struct Changes {
  cv::Mat1b classes;
  std::vector<Region> regions;  // the largest volume first
  Volume came, gone;
  double net = 0, net_sigma = 0;  // what came minus what went [m^3]
  double area_compared = 0;       // [m^2]
};

// What the volumes need besides the differences.
struct VolumeFacts {
  map::MapGrid grid;
  const Registration& registration;  // its uncertainty is common to all pixels
  double correlation = 1;            // Noise::correlation
  cv::Mat1b unseen = {};             // above 0: a survey did not see the pixel; empty: all are seen
};

// Finds the changes. `difference`: later minus earlier height [m], NaN: not compared. `sigma`: its
// standard deviation [m]. The standard deviations of volumes include those of the differences and
// the uncertainty of the registration. The result does not depend on the number of threads.
Changes find_changes(const cv::Mat1f& difference, const cv::Mat1f& sigma, const VolumeFacts& facts,
                     const ChangeOptions& options = {});

}  // namespace axial::compare
