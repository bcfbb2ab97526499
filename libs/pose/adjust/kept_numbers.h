// SPDX-License-Identifier: GPL-3.0-or-later
// Which measured numbers of the cameras the observations do not contradict.
#pragma once

#include <array>
#include <vector>

#include "pose/adjust/uncertainty.h"
#include "pose/bundle/adjust_options.h"

namespace axial::pose {

// Returns, by index of the camera, the free numbers that should keep their measured values.
//
// Noise of the observations moves every number that is adjusted, and depths with it: behind a flat
// port, index and focal length have nearly the same effect, so that their standard deviations are
// large. Most measured numbers of a dive are nearly right, and few are wrong. Therefore a number is
// adjusted only if its adjustment lowers the cost (the cost of adjust(), in squared standard
// deviations) by more than 6. Noise alone lowers it so far for 1.4 % of right numbers.
//
// The costs follow from the result of adjust() with all free numbers: if the numbers F go back to
// their measured values and all others follow, the cost grows by m' inverse(C) m, with the changes
// m of F and their covariance C. Starting with none, the number that adds least to this cost is
// kept next, as long as it adds at most 6. Numbers without a measured value are not kept.
//
// Precondition: adjust() was called for `bundle` with the same `options`.
std::vector<std::array<bool, kHousingNumbers>> numbers_to_keep(const Bundle& bundle,
                                                               const AdjustOptions& options);

// The same by the covariance of the numbers. Returns indices into `numbers.numbers`, ascending.
// `changes`: of these numbers; an entry that is not finite is not kept.
std::vector<std::size_t> numbers_to_keep(const NumbersCovariance& numbers,
                                         const Eigen::VectorXd& changes);

}  // namespace axial::pose
