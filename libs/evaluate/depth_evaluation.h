// SPDX-License-Identifier: GPL-3.0-or-later
// Compares a depth map with the true distances along the rays of its pixels.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "evaluate/statistics.h"

namespace axial::evaluate {

struct DepthOptions {
  // Tolerances of the scores [m]: at least one. The histogram ends at 4 * the first tolerance.
  std::vector<double> tolerances{0.005};
  std::size_t rings = 8;            // number of rings around the image centre; at least 1
  std::size_t histogram_bins = 80;  // number of bins of DepthEvaluation::accuracy_histogram
};

// Errors of the pixels in a ring around the image centre. Let r be the distance of a pixel from the
// image centre, divided by half the diagonal of the image. The pixel is in the ring if r is in
// [inner, outer).
struct Ring {
  double inner = 0, outer = 0;
  std::size_t count = 0;     // pixels of the ring that have an estimate and a truth
  double signed_median = 0;  // of estimate - truth [m]; 0 without pixels; shows a wrong lens model
  double absolute_median = 0;  // of |estimate - truth| [m]; 0 without pixels
};

// The result of evaluate_depth().
struct DepthEvaluation {
  cv::Mat1f truth;                            // [m], at the estimate's resolution; 0: no truth
  cv::Mat1f error;                            // estimate - truth [m]; NaN where either is missing
  DistanceStatistics accuracy;                // of |error| [m]
  Histogram accuracy_histogram;               // of |error| [m], from 0 to 4 * the first tolerance
  double signed_mean = 0, signed_median = 0;  // of estimate - truth [m]
  std::size_t truth_pixels = 0;               // pixels that have a truth
  std::size_t estimated_pixels = 0;           // pixels that have an estimate
  std::size_t compared_pixels = 0;            // pixels that have both
  double completeness = 0;                    // compared_pixels / truth_pixels
  // One score for each tolerance. A pixel is within the tolerance if |error| is at most the
  // tolerance. Precision is the number of these pixels divided by compared_pixels. Recall is their
  // number divided by truth_pixels.
  std::vector<Score> scores;
  std::vector<Ring> rings;  // DepthOptions::rings rings, from the image centre to the corners
};

// Compares `estimate` with `truth` at the resolution of `estimate`. Both maps hold lambda [m], the
// distance along the pixel's ray from the ray's origin on the axis. In air the origin is the camera
// centre. Pixels that are not positive or not finite have no value. If the maps have different
// sizes, resample_distance() gives the truth at the pixels of `estimate`. Error if a map is empty,
// if there is no tolerance, if a tolerance is not positive and finite, if the maps have different
// aspect ratios, or if no pixel has both an estimate and a truth. Aspect ratios are different if
// the truth, scaled to the width of the estimate, has a height that differs by more than one row.
DepthEvaluation evaluate_depth(const cv::Mat1f& estimate, const cv::Mat1f& truth,
                               const DepthOptions& options);

// Relative errors in a ring of several maps of one camera.
struct RelativeRing {
  double inner = 0, outer = 0;  // limits of the ring, as in Ring
  std::size_t count = 0;        // pixels of all maps in the ring that have an estimate and a truth
  double signed_median = 0;     // of (estimate - truth) / truth; 0 without pixels
};

// Returns `count` rings of equal width, from the image centre to the corners. Each ring summarises
// its pixels of all maps. A wrong lens model gives relative errors that grow with the distance from
// the image centre. Precondition: `count` is at least 1.
std::vector<RelativeRing> relative_rings(std::span<const DepthEvaluation> maps, std::size_t count);

// Returns the true distances at the pixels of a map of size `size`. `truth`: distances [m]; pixels
// that are not positive or not finite have no value. If the sizes are equal, the result is a copy.
// Otherwise column u of the result lies at (u + 1/2) * scale - 1/2 in the truth, with scale = width
// of the truth / width of the result. Rows lie correspondingly, with the heights. Positions outside
// the outermost pixel centres of the truth are moved onto them. The result is interpolated
// bilinearly in 1/distance, which is nearly linear on a plane. Exception: the result is the nearest
// pixel of the truth (0 if this pixel has no value) if one of the four surrounding pixels has no
// value, or if their largest distance exceeds their smallest by more than 5 % (an edge).
// Precondition: neither size is empty.
cv::Mat1f resample_distance(const cv::Mat1f& truth, cv::Size size);

}  // namespace axial::evaluate
