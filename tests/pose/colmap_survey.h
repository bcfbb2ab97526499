// SPDX-License-Identifier: GPL-3.0-or-later
// A survey as COLMAP files: a distorting lens, and a model of its photographs.
#pragma once

#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"
#include "pose/survey.h"

namespace axial::pose::testing {

inline const io::ColmapCamera kLens{
    4, "OPENCV", 1024, 768, {620, 615, 512, 384, -0.12, 0.02, 1e-4, -2e-4}};

// A flat port, tilted by 2 degrees, for all cameras.
io::Housing housing();

// The pixel at which kLens images the in-air direction (u, v, 1), by COLMAP's formula for the model
// OPENCV. Pixel centres are at integers.
Eigen::Vector2d seen_by_lens(double u, double v);

// Returns the survey `bundle` as a COLMAP model with the camera kLens: the observations are the
// pixels of kLens.
io::ColmapModel model_of(const Bundle& bundle);

}  // namespace axial::pose::testing
