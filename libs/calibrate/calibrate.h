// SPDX-License-Identifier: GPL-3.0-or-later
// Calibrates the port of a housing from photographs of a board, taken under water through the port.
// The lens has been calibrated in air before.
#pragma once

#include "calibrate/board_bundle.h"
#include "pose/adjust.h"

namespace axial::calibrate {

struct CalibrateOptions {
  // The unknown numbers and the standard deviations of their measurements. calibrate() sets
  // adjust.points_known.
  pose::AdjustOptions adjust;
  double max_error = 4;  // corners with larger reprojection errors are dropped [px]
};

struct Calibration {
  std::vector<View> views;  // used photographs, with the corners as found
  // One camera, and an image for each view. Dropped corners are not among its observations.
  pose::ColmapBundle bundle;
  pose::AdjustOptions adjust;  // options of the last adjustment
  pose::AdjustReport last;
  pose::Uncertainty uncertainty;
  // Photographs that are not used, for one of three reasons: too few corners, corners that do not
  // determine a pose, or too few corners that fit.
  std::vector<std::string> left_out;

  const pose::BundleCamera& camera() const { return bundle.bundle.cameras[0]; }
};

// Adjusts the board poses and the unknown numbers of the port. Minimises the squared reprojection
// errors of the corners (exact projection, Huber loss). The adjustment starts from `port`. The
// poses need no initial values. `corners`: the corners of the board [m], in the order of their
// numbers. A photograph is used if it shows 8 corners or more, if its corners determine its pose,
// and if 8 corners or more have an error of at most max_error. Throws an Error if fewer than 3
// photographs can be used. Whether the result is precise enough is checked separately (advice.h).
Calibration calibrate(const io::ColmapCamera& lens, const refractive::Port<double>& port,
                      std::span<const View> views, std::span<const Eigen::Vector3d> corners,
                      const CalibrateOptions& options);

}  // namespace axial::calibrate
