// SPDX-License-Identifier: GPL-3.0-or-later
// The outlines of a region of the plane that is known place by place.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "geometry/polygon_pieces.h"

namespace axial::geometry {

// Places in rows and columns: the place (x, y) is at first + step * (x, y).
struct SampleGrid {
  Eigen::Vector2d first;
  double step = 1;  // above 0
  int columns = 0, rows = 0;

  Eigen::Vector2d at(double x, double y) const { return first + step * Eigen::Vector2d(x, y); }
};

// Whether a place belongs to the region. Called concurrently.
using IsInside = std::function<bool(const Eigen::Vector2d& place)>;

// Returns the parts of a region: of each the outline, with positive area in the plane with x to the
// right and y upwards, and then the holes, with negative area.
//
// The region is sampled at the grid; a piece between the samples is not found. While a sample at
// the rim of the grid is inside, the grid grows, up to `most` samples. Around the outline, samples
// follow at half a step. Between two neighbouring samples, of which one is inside, the place of the
// outline is found by bisection, up to 1/256 of a step on the side of the region. Between these
// places the outline is straight (marching squares), so that a right angle is cut by up to 0.36 of
// a step; samples that touch at a corner alone are apart. Corners that lie nearer than a hundredth
// of a step to the straight line between others are left out. Rings with fewer than three corners
// are left out.
std::vector<std::vector<Ring>> region_outlines(SampleGrid grid, const IsInside& is_inside,
                                               double most = 64e6);

}  // namespace axial::geometry
