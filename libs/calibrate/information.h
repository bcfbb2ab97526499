// SPDX-License-Identifier: GPL-3.0-or-later
// The information that photographs of a board give about the camera. The information of several
// photographs is the sum of the information of each, because the board is known and each photograph
// has a pose of its own. The bundles are those of board_bundle(): with one camera, and with the
// corners of the board as points.
#pragma once

#include "pose/bundle/adjust_options.h"

namespace axial::calibrate {

// The information matrix of the numbers of a camera, in the order and units of
// pose/bundle/housing_change.h. If all numbers are free, the inverse of this matrix is their
// covariance.
using Information = Eigen::Matrix<double, pose::kHousingNumbers, pose::kHousingNumbers>;

// The information of the observations of the image with the index `image` in bundle.images, if
// their noise has a standard deviation of 1 px. For another noise divide by its variance [px^2].
// The pose of the image is unknown and eliminated. The corners of the board are known.
Information information(const pose::Bundle& bundle, std::size_t image);

// The sum of two parts: the information of all images, whose observations have a noise of
// `pixel_sigma` [px, above 0], and the information of the measurements of numbers whose standard
// deviations are options.prior_sigma.
Information total_information(const pose::Bundle& bundle, const pose::AdjustOptions& options,
                              double pixel_sigma);

// The standard deviations of the numbers that `options` declares free (options.free), in the units
// of pose/bundle/housing_change.h. The value is very large, but finite, for a number that
// `information` does not determine, and 0 for a number that is not free.
pose::HousingChange<double> sigmas_from(const Information& information,
                                        const pose::AdjustOptions& options);

}  // namespace axial::calibrate
