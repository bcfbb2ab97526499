// SPDX-License-Identifier: GPL-3.0-or-later
// Photographs of a board as a bundle whose points are the board's corners.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "calibrate/board.h"
#include "io/colmap/colmap.h"
#include "pose/colmap_bundle.h"

namespace axial::calibrate {

// One photograph and the board's corners in it.
struct View {
  std::string image;
  std::vector<Corner> corners;
};

// The views as images of one camera behind `port`. The board is the world frame, with `corners` [m]
// by number as points. `poses` are the images' poses, or empty if they are unknown. An
// observation's `source` is the corner's index within its view.
pose::ColmapBundle board_bundle(const io::ColmapCamera& lens, const refractive::Port<double>& port,
                                std::span<const View> views,
                                std::span<const Eigen::Vector3d> corners,
                                std::span<const Pose> poses = {});

// The corners that the camera of `bundle` images at `pose`, at least one pixel inside the
// photograph. Pixels of the photograph.
std::vector<Corner> photographed(const pose::ColmapBundle& bundle,
                                 std::span<const Eigen::Vector3d> corners, const Pose& pose);

}  // namespace axial::calibrate
