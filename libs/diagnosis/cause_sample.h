// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a reconstruction in which residual_causes() looks for a cause.
#pragma once

#include <span>

#include "diagnosis/residuals.h"

namespace axial::diagnosis {

// Returns at most `most_images` images with their common points: the images that a breadth-first
// search along common points finds first. It begins at the image of camera `camera` with the most
// observations. Of the points that two or more of these images see, those with the most
// observations are taken, until there are `most_observations`. All cameras are kept. Observations
// without a residual in `freed` (see residual_vectors()) and outliers are left out.
TrackedPhotographs cause_sample(const TrackedPhotographs& photographs,
                                std::span<const Eigen::Vector2d> freed, std::size_t camera,
                                std::size_t most_images, std::size_t most_observations);

}  // namespace axial::diagnosis
