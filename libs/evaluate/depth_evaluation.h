// SPDX-License-Identifier: GPL-3.0-or-later
// Compares a depth map with the true distances along the rays of its pixels.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "evaluate/statistics.h"

namespace axial::evaluate {

struct DepthOptions {
  std::vector<double> tolerances{0.005};  // [m]; the first scales histograms and colours
  std::size_t rings = 8;
  std::size_t histogram_bins = 80;
};

// A ring around the image centre; radii are fractions of the half diagonal.
struct Ring {
  double inner = 0, outer = 0;
  std::size_t count = 0;
  double signed_median = 0;    // of estimate - truth [m]; shows a wrong lens model
  double absolute_median = 0;  // [m]
};

struct DepthEvaluation {
  cv::Mat1f truth;              // at the estimate's resolution; 0: no truth
  cv::Mat1f error;              // estimate - truth [m]; NaN where either is missing
  DistanceStatistics accuracy;  // of |error|
  Histogram accuracy_histogram;
  double signed_mean = 0, signed_median = 0;
  std::size_t truth_pixels = 0;      // pixels that have a truth
  std::size_t estimated_pixels = 0;  // pixels that have an estimate
  std::size_t compared_pixels = 0;   // pixels that have both
  double completeness = 0;           // compared / truth
  // Precision: share of the compared pixels within the tolerance. Recall: share of the pixels with
  // a truth that are within the tolerance.
  std::vector<Score> scores;
  std::vector<Ring> rings;
};

// Both maps hold lambda, the distance along the pixel's ray from the ray's origin on the axis (in
// air: from the camera centre) [m]. Pixels that are 0 or not finite have no value. Error for an
// empty map, maps of different aspect (more than one row off), no tolerance or a tolerance that is
// not positive, or no pixel in common.
DepthEvaluation evaluate_depth(const cv::Mat1f& estimate, const cv::Mat1f& truth,
                               const DepthOptions& options);

// A ring as above, for relative errors in several maps of one camera.
struct RelativeRing {
  double inner = 0, outer = 0;
  std::size_t count = 0;
  double signed_median = 0;  // (estimate - truth) / truth
};

// Returns `count` rings over all pixels of all maps that have an error. A wrong lens model gives
// relative errors that grow with the distance from the image centre.
std::vector<RelativeRing> relative_rings(std::span<const DepthEvaluation> maps, std::size_t count);

// Returns the truth at the pixels of a map of another size. Maps of equal size have the same
// pixels. Otherwise pixel u is at (u + 1/2) * scale - 1/2 in the truth, where 1/distance is
// interpolated bilinearly, because it is nearly linear on a plane. If one of the four pixels around
// is missing, or they differ by more than 5 % (an edge), the nearest pixel is taken.
cv::Mat1f resample_distance(const cv::Mat1f& truth, cv::Size size);

}  // namespace axial::evaluate
