// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the regions in which the difference of two surveys is significant, and their volumes.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "axial/compare.h"
#include "compare/registration.h"
#include "map/frame.h"

namespace axial::compare {

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
