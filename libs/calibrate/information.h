// SPDX-License-Identifier: GPL-3.0-or-later
// The information that photographs of a board give about the camera. The information of several
// photographs is the sum of the information of each, because the board is known and each photograph
// has a pose of its own.
#pragma once

#include "pose/adjust.h"

namespace axial::calibrate {

// The normal matrix of the numbers of a camera (housing_change.h). The inverse of this matrix is
// the covariance of the numbers.
using Information = Eigen::Matrix<double, pose::kHousingNumbers, pose::kHousingNumbers>;

// The information of the observations of one image, for noise of 1 px. The pose of the image is
// unknown and eliminated.
Information information(const pose::Bundle& bundle, std::size_t image);

// The sum of two parts: the information of all images for noise of `pixel_sigma` [px], and the
// information of the measurements whose standard deviations are in `options`.
Information total_information(const pose::Bundle& bundle, const pose::AdjustOptions& options,
                              double pixel_sigma);

// The standard deviations of the numbers that `options` declares free. The value is very large for
// a number that no photograph determines, and 0 for a number that is not free.
pose::HousingChange<double> sigmas_from(const Information& information,
                                        const pose::AdjustOptions& options);

}  // namespace axial::calibrate
