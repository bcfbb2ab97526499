// SPDX-License-Identifier: GPL-3.0-or-later
// How much photographs of a board tell of the camera. Since the board is known and each photograph
// has a pose of its own, what they tell adds up.
#pragma once

#include "pose/adjust.h"

namespace axial::calibrate {

// The normal matrix of a camera's numbers (housing_change.h): its inverse is their covariance.
using Information = Eigen::Matrix<double, pose::kHousingNumbers, pose::kHousingNumbers>;

// What the observations of one image tell whose noise is 1 px, wherever the board was.
Information information(const pose::Bundle& bundle, std::size_t image);

// What all images and what was measured tell, with the noise `pixel_sigma`.
Information total_information(const pose::Bundle& bundle, const pose::AdjustOptions& options,
                              double pixel_sigma);

// Standard deviations of the free numbers; huge where nothing tells them, 0 for the others.
pose::HousingChange<double> sigmas_from(const Information& information,
                                        const pose::AdjustOptions& options);

}  // namespace axial::calibrate
