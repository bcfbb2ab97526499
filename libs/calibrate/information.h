// SPDX-License-Identifier: GPL-3.0-or-later
// The information that photographs of a board give about the camera. The board is known and each
// photograph has its own pose, so the information of photographs adds up.
#pragma once

#include "pose/adjust.h"

namespace axial::calibrate {

// The normal matrix of a camera's numbers (housing_change.h): its inverse is their covariance.
using Information = Eigen::Matrix<double, pose::kHousingNumbers, pose::kHousingNumbers>;

// The information of one image's observations with noise of 1 px, with the pose eliminated.
Information information(const pose::Bundle& bundle, std::size_t image);

// The information of all images with noise `pixel_sigma` [px], and of the measured standard
// deviations of `options`.
Information total_information(const pose::Bundle& bundle, const pose::AdjustOptions& options,
                              double pixel_sigma);

// Standard deviations of the free numbers: very large where no photograph determines a number, 0
// for numbers that are not free.
pose::HousingChange<double> sigmas_from(const Information& information,
                                        const pose::AdjustOptions& options);

}  // namespace axial::calibrate
