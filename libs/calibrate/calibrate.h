// SPDX-License-Identifier: GPL-3.0-or-later
// Calibrates the port of a housing from photographs of a board, taken under water through the port.
// The lens has been calibrated in air before.
#pragma once

#include "calibrate/board_bundle.h"
#include "pose/adjust.h"

namespace axial::calibrate {

// Settings of calibrate().
struct CalibrateOptions {
  // The unknown numbers of the camera and the standard deviations with which they were measured.
  // calibrate() sets adjust.points_known. After the first of several rounds, calibrate() replaces
  // adjust.pixel_sigma by the observed standard deviation of the corners.
  pose::AdjustOptions adjust;
  double max_error = 4;  // corners with larger reprojection errors are dropped [px]
};

// The result of calibrate().
struct Calibration {
  std::vector<View> views;  // the used photographs, with all corners that were found
  // One camera, and one image for each of `views`, in the same order. The world frame is the frame
  // of the board [m]. Dropped corners are not among the observations.
  pose::ColmapBundle bundle;
  pose::AdjustOptions adjust;  // options of the last adjustment
  pose::AdjustReport last;     // report of the last adjustment
  // Standard deviations of the result; that of the scale has no use here.
  pose::Uncertainty uncertainty;
  // The names (View::image) of the photographs that are not used, for one of three reasons: too few
  // corners, corners that do not determine a pose, or too few corners that fit.
  std::vector<std::string> left_out;

  // The calibrated camera: the measured and the calibrated numbers.
  const pose::BundleCamera& camera() const { return bundle.bundle.cameras[0]; }
};

// Finds the unknown numbers of the camera, and its pose in each photograph, that minimise the
// squared reprojection errors of the corners (exact projection, Huber loss). `lens` and `port` have
// the measured numbers, from which the adjustment starts. The poses need no initial values.
// `corners`: the corners of the board [m], in the order of their numbers.
// A photograph is used if it shows 8 corners or more, if its corners determine its pose, and if 8
// corners or more have an error of at most max_error (4 max_error in the first of three rounds).
// Throws an Error if fewer than 3 photographs can be used. Whether the result is precise enough is
// checked separately (advice.h).
Calibration calibrate(const io::ColmapCamera& lens, const refractive::Port<double>& port,
                      std::span<const View> views, std::span<const Eigen::Vector3d> corners,
                      const CalibrateOptions& options);

}  // namespace axial::calibrate
