// SPDX-License-Identifier: GPL-3.0-or-later
// Known positions judged by the camera centres of a bundle: which are wrong, and how accurate the
// others are.
#pragma once

#include <string>
#include <vector>

#include "pose/bundle/adjust_options.h"

namespace axial::pose {

// The smallest standard deviation that judge_positions() estimates [m]. Exact positions, as of a
// simulator, keep their weight in bundle adjustment, and no divisor becomes zero.
inline constexpr double kLeastPositionSigma = 0.001;

// Removes wrong positions, and estimates the standard deviations that nobody stated. Returns a line
// for each position that was removed (outlier_lines() in scene/robust_similarity.h).
//
// The camera centres are moved to the positions by a robust similarity (robust_similarity()), whose
// outliers are removed. Neither the place nor the scale of the bundle therefore matters: refraction
// determines the scale weakly, and wrongly behind a wrong port.
//
// Let d be the distances of the n positions with `sigma_is_guess` from the moved centres, and N the
// number of all positions. The variance of their coordinates is the sum of d^2 divided by f = 3 n -
// 7 n / N - 1 (at least 1): a similarity has seven free numbers. Without the last 1 in f, the
// variance would be unbiased, but three positions would state a standard deviation that is too
// small too often: with this 1, the truth lies within three standard deviations in 95 % of all
// cases for any number of positions. Distances above three standard deviations count as three. The
// result is multiplied by `factor`, but is at least kLeastPositionSigma.
//
// Positions of images without observations (lost_positions() in known.h) do not count and stay. If
// fewer than three others are left, nothing changes.
std::vector<std::string> judge_positions(const Bundle& bundle, double factor,
                                         std::vector<KnownPosition>& positions);

// The distances of known positions from the camera centres of a bundle.
struct PositionDistances {
  std::size_t count = 0;  // positions of images with observations
  double rms = 0;         // root mean square of their distances [m]
  // The standard deviation of the coordinates in multiples of what was stated: about 1 if the
  // stated standard deviations are right. It counts the freedom of a similarity as
  // judge_positions() does. 0: no standard deviation was stated.
  double of_stated = 0;
};

PositionDistances position_distances(const Bundle& bundle,
                                     const std::vector<KnownPosition>& positions);

// Stated standard deviations are contradicted if PositionDistances::of_stated is larger than this.
// By chance it is in 1 % of all cases with three positions, and practically never with more.
inline constexpr double kContradicted = 3;

// If the stated standard deviations are contradicted, multiplies them by `distances.of_stated`, so
// that standard deviations of results are not too small.
void correct_contradicted(const PositionDistances& distances,
                          std::vector<KnownPosition>& positions);

}  // namespace axial::pose
