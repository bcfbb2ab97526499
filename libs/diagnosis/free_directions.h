// SPDX-License-Identifier: GPL-3.0-or-later
// Removes the part of vectors over observations that changes of poses and points explain.
#pragma once

#include <span>

#include "diagnosis/residuals.h"

namespace axial::diagnosis {

// Linearized observations: the terms of `observations`, in their order. All terms are visible.
struct LinearizedTracks {
  std::vector<pose::Observation> observations;
  std::vector<ObservationTerm> terms;
  std::vector<Eigen::Vector3d> centres;  // of the images
  std::size_t points = 0;                // number of points
};

// Replaces each column of `columns` by its difference from the nearest combination of changes of
// poses and points. Rows 2 i and 2 i + 1 of `columns` are the x and y [px] of observation i. The
// changes keep the distance between the first camera centre and the one farthest from it: otherwise
// a change of the scale could explain a wrong length of a port. The cost grows with the third power
// of the number of images.
void remove_poses_and_points(const LinearizedTracks& tracks, Eigen::MatrixXd& columns);

}  // namespace axial::diagnosis
