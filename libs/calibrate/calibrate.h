// SPDX-License-Identifier: GPL-3.0-or-later
// Calibrates the port of a housing from underwater photographs of a board taken through it, and the
// lens as calibrated in air.
#pragma once

#include "calibrate/board_bundle.h"
#include "pose/adjust.h"

namespace axial::calibrate {

struct CalibrateOptions {
  // Unknowns and their measured standard deviations. calibrate() sets points_known.
  pose::AdjustOptions adjust;
  double max_error = 4;  // corners with larger errors are dropped [px of the photograph]
};

struct Calibration {
  std::vector<View> views;  // used photographs, with the corners as found
  // One camera, and an image for each view. Dropped corners are not among its observations.
  pose::ColmapBundle bundle;
  pose::AdjustOptions adjust;  // options of the last adjustment
  pose::AdjustReport last;
  pose::Uncertainty uncertainty;
  // Photographs with too few corners, with corners that do not determine a pose, or with too few
  // corners that fit.
  std::vector<std::string> left_out;

  const pose::BundleCamera& camera() const { return bundle.bundle.cameras[0]; }
};

// Adjusts the board poses and the unknown numbers of the port to the least squared reprojection
// errors of the corners (exact projection, Huber loss). Starts from `port`; the poses need no
// initial values. `corners`: of the board [m], by number. Error if fewer than 3 photographs show 8
// corners or more, determine a pose, or keep 8 corners that fit. Whether the result is precise
// enough is checked separately (advice.h).
Calibration calibrate(const io::ColmapCamera& lens, const refractive::Port<double>& port,
                      std::span<const View> views, std::span<const Eigen::Vector3d> corners,
                      const CalibrateOptions& options);

}  // namespace axial::calibrate
