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
  std::string image;  // the name of the photograph, in messages and lists
  std::vector<Corner> corners;
  // True: the photograph shows a piece of a checkerboard. Its corners have the numbers of an equal
  // piece at the first corner of the board, because the place of the piece on the board is unknown.
  // Each photograph has a pose of its own, so that the place does not matter.
  bool piece = false;
  // The corners with their numbers after a quarter of a turn, if this is possible, too. Else empty.
  std::vector<Corner> turned = {};
  // Why there are no corners, as a text that follows the name of the photograph.
  std::string fault = {};
};

// Returns a bundle with one camera, `lens` behind `port`. The images of the bundle are the views,
// in their order. The points of the bundle are `corners` [m], in the order of their numbers: every
// Corner::number of `views` must be below their count. The frame of the board is the world frame.
// `poses`: the poses of the images, one for each view, or empty if they are unknown. The `source`
// of an observation is the index of the corner in View::corners.
pose::ColmapBundle board_bundle(const io::ColmapCamera& lens, const refractive::Port<double>& port,
                                std::span<const View> views,
                                std::span<const Eigen::Vector3d> corners,
                                std::span<const Pose> poses = {});

// Projects `corners` [m, world frame] into the first camera of `bundle` at `pose`. Returns the
// corners whose image lies at least one pixel inside the edges of the photograph, in the order of
// `corners`. Corner::number is the index into `corners`.
std::vector<Corner> photographed(const pose::ColmapBundle& bundle,
                                 std::span<const Eigen::Vector3d> corners, const Pose& pose);

}  // namespace axial::calibrate
