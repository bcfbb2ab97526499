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

// Returns a bundle with one camera behind `port` and the views as its images. The points of the
// bundle are `corners` [m], in the order of their numbers. The frame of the board is the world
// frame. `poses`: the poses of the images, or empty if they are unknown. The `source` of an
// observation is the index of the corner within its view.
pose::ColmapBundle board_bundle(const io::ColmapCamera& lens, const refractive::Port<double>& port,
                                std::span<const View> views,
                                std::span<const Eigen::Vector3d> corners,
                                std::span<const Pose> poses = {});

// Projects `corners` [m] into the camera of `bundle` at `pose`. Returns the corners that the camera
// sees at least one pixel inside the edges of the photograph, in pixels of the photograph.
std::vector<Corner> photographed(const pose::ColmapBundle& bundle,
                                 std::span<const Eigen::Vector3d> corners, const Pose& pose);

}  // namespace axial::calibrate
