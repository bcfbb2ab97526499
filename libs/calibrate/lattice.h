// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/calibrate: connects saddles to a lattice.
#pragma once

#include <span>

#include "calibrate/saddles.h"

namespace axial::calibrate {

// A saddle with its place in a lattice. x grows along one family of lines of the lattice, y along
// the other one; seen in the photograph, y is x turned from the right towards below.
struct LatticeCorner {
  Eigen::Vector2i cell{0, 0};
  std::size_t saddle = 0;  // index
};

// Returns the largest regular piece of a checkerboard: the corners that are connected by edges
// between neighbours. A neighbour is the next saddle along an edge, with dark and bright sides
// exchanged, and the photograph shows the edge on the whole way between both. Each corner belongs
// to a cell of which all four corners are found. Empty if there is no such cell. `smooth`:
// find_saddles().
std::vector<LatticeCorner> largest_lattice(const cv::Mat1f& smooth,
                                           std::span<const Saddle> saddles);

}  // namespace axial::calibrate
