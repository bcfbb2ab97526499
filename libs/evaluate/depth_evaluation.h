// SPDX-License-Identifier: GPL-3.0-or-later
// A depth map against the true distance along each pixel's ray.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "evaluate/statistics.h"

namespace axial::evaluate {

struct DepthOptions {
  std::vector<double> tolerances{0.005};  // [m]; the first one scales histograms and colours
  std::size_t rings = 8;
  std::size_t histogram_bins = 80;
};

// A ring around the image centre; radii are fractions of the half diagonal.
struct Ring {
  double inner = 0, outer = 0;
  std::size_t count = 0;
  double signed_median = 0;    // of estimate - truth [m]: a lens modelled wrongly shows here
  double absolute_median = 0;  // [m]
};

struct DepthEvaluation {
  cv::Mat1f truth;              // at the estimate's resolution; 0: none
  cv::Mat1f error;              // estimate - truth [m]; NaN where either is missing
  DistanceStatistics accuracy;  // of |error|
  Histogram accuracy_histogram;
  double signed_mean = 0, signed_median = 0;
  std::size_t truth_pixels = 0;      // pixels that have a truth
  std::size_t estimated_pixels = 0;  // pixels that have an estimate
  std::size_t compared_pixels = 0;   // pixels that have both
  double completeness = 0;           // compared / truth
  // Precision: share of the compared pixels within the tolerance; recall: share of the pixels with
  // a truth.
  std::vector<Score> scores;
  std::vector<Ring> rings;
};

// Both maps hold lambda, metres along the pixel's ray from its origin on the axis (in air: the
// range); 0 or not finite: nothing. Error for an empty map, maps of different shape (aspect off by
// more than a pixel), no tolerance, no pixel in common.
DepthEvaluation evaluate_depth(const cv::Mat1f& estimate, const cv::Mat1f& truth,
                               const DepthOptions& options);

// A ring as above, over several maps of one camera.
struct RelativeRing {
  double inner = 0, outer = 0;
  std::size_t count = 0;
  double signed_median = 0;  // (estimate - truth) / truth
};

// All pixels of all maps that have an error, `count` rings. A depth that is wrong by a part of
// itself, the more so the farther from the centre, is what a lens modelled wrongly does.
std::vector<RelativeRing> relative_rings(std::span<const DepthEvaluation> maps, std::size_t count);

// The truth where the rays of a map of another size pass. Equal sizes: the same pixels. Otherwise
// the position (u + 1/2) * scale - 1/2 is read off bilinearly in 1/distance (which is what a plane
// is nearly linear in), unless one of the four pixels around it is missing or they differ by more
// than 5 %: across an edge the nearest pixel counts.
cv::Mat1f resample_distance(const cv::Mat1f& truth, cv::Size size);

}  // namespace axial::evaluate
