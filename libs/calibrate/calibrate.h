// SPDX-License-Identifier: GPL-3.0-or-later
// Calibrates the port of a housing from photographs of a board, taken under water through the port.
// The lens has been calibrated in air before.
#pragma once

#include "calibrate/board_bundle.h"
#include "pose/adjust/adjust.h"
#include "pose/adjust/uncertainty.h"

namespace axial::calibrate {

// Settings of calibrate().
struct CalibrateOptions {
  // The unknown numbers of the camera and the standard deviations with which they were measured.
  // calibrate() sets adjust.points_known. After the first of several rounds, calibrate() replaces
  // adjust.pixel_sigma by the observed standard deviation of the corners.
  pose::AdjustOptions adjust;
  double max_error = 4;  // corners with larger reprojection errors are dropped [px]
};

// A photograph that calibrate() does not use.
struct LeftOut {
  std::string image;   // View::image
  std::string reason;  // a text that follows the name
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
  // The photographs that are not used, for one of four reasons: too few corners, corners that do
  // not determine a pose, too few corners that fit, or a piece that is not one of the board.
  std::vector<LeftOut> left_out;

  // The number of `views` that show a piece of a checkerboard.
  std::size_t pieces() const;

  // The calibrated camera: the measured and the calibrated numbers.
  const pose::BundleCamera& camera() const { return bundle.bundle.cameras[0]; }
};

// Finds the unknown numbers of the camera, and its pose in each photograph, that minimise the
// squared reprojection errors of the corners (exact projection, Huber loss). `lens` and `port` have
// the measured numbers, from which the adjustment starts. The poses need no initial values.
// `corners`: the corners of the board [m], in the order of their numbers.
// A photograph is used if it shows 8 corners or more, if its corners determine its pose, and if 8
// corners or more have an error of at most max_error (4 max_error in the first of three rounds).
// A piece of a checkerboard (View::piece) may be wrong as a whole, for example because a row is
// skipped in it. It is left out if more than a quarter of its corners are dropped, or if the RMS of
// its errors is more than four times the median of all photographs, and more than 0.5 px.
// Views whose corners can be numbered in two ways (View::turned) get the numbers with the smaller
// errors. They are chosen with the measured port, and again with the calibrated port, until no
// choice changes, at most four times.
// Throws an Error if fewer than 3 photographs can be used. Whether the result is precise enough is
// checked separately (advice.h).
Calibration calibrate(const io::ColmapCamera& lens, const refractive::Port<double>& port,
                      std::span<const View> views, std::span<const Eigen::Vector3d> corners,
                      const CalibrateOptions& options);

}  // namespace axial::calibrate
