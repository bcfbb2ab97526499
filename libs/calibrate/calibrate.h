// SPDX-License-Identifier: GPL-3.0-or-later
// The port of a housing from photographs of a board taken through it, under water, and the lens as
// calibrated in air.
#pragma once

#include "calibrate/board_bundle.h"
#include "pose/adjust.h"

namespace axial::calibrate {

struct CalibrateOptions {
  // What is unknown, and how well it was measured; points_known is set here.
  pose::AdjustOptions adjust;
  double max_error = 4;  // corners with larger errors are dropped [px of the photograph]
};

struct Calibration {
  std::vector<View> views;     // those used, with the corners as found
  pose::ColmapBundle bundle;   // one camera; an image for each view; corners that were dropped are
                               // not among its observations
  pose::AdjustOptions adjust;  // as used last
  pose::AdjustReport last;
  pose::Uncertainty uncertainty;
  std::vector<std::string> left_out;  // photographs with too few corners, or that do not tell
                                      // where the board is, or with too few that fit

  const pose::BundleCamera& camera() const { return bundle.bundle.cameras[0]; }
};

// Board poses and what `options` leave unknown of the port, where the corners' errors are least:
// exact forward projection, Huber's loss. Starts from `port`, and from nothing known of the poses.
// `corners`: of the board [m], by number. Error where fewer than 3 photographs show 8 corners
// or more, or keep as many that fit.
// Whether the result is well known is another question: advice.h.
Calibration calibrate(const io::ColmapCamera& lens, const refractive::Port<double>& port,
                      std::span<const View> views, std::span<const Eigen::Vector3d> corners,
                      const CalibrateOptions& options);

}  // namespace axial::calibrate
