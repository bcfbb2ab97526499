// SPDX-License-Identifier: GPL-3.0-or-later
// Aligns the mesh of a survey with the mesh of an earlier one by the surface that did not change.
#pragma once

#include <Eigen/Core>

#include "axial/compare.h"
#include "base/progress.h"
#include "map/frame.h"
#include "map/world_axes.h"
#include "scene/decompositions.h"
#include "scene/mesh.h"

namespace axial::compare {

// The frame that gives a point of the mesh the map coordinates motion(frame.to_map(point)).
map::MapFrame moved(const map::MapFrame& frame, const RigidMotion& motion);

// The motion in world coordinates, for a motion on the map `map`.
Similarity in_world(const RigidMotion& motion, const map::WorldAxes& map);

// The row of derivatives of the height at a fixed place of the map by a motion of the surface
// (rotation vector, translation). `offset`: the place minus the centre of the motion.
Vector6d height_row(const Eigen::Vector3d& offset, const Eigen::Vector2d& slope);

// Finds the rigid motion of `after` that aligns it with `before`. Starts from the given positions.
// `frame`: of both meshes. `grid`: the part of the map in which both are compared.
//
// The first motion is that of refine_rigid() (geometry/icp.h), by the distances of the vertices of
// `after` over the grid from the nearest points of `before`. As long as the positions differ much,
// it leaves out less of steep ground than differences of heights would. If the surface does not
// determine all six directions (see below), the given positions are the start instead, because
// noise moves the nearest points along level ground.
//
// Then the distance between both surfaces is measured along the height axis at a regular grid of
// samples, divided by sqrt(1 + slope^2), which is the distance to the tangent plane. Gauss-Newton
// steps minimise the sum of the squared distances of the samples that are not left out. The
// derivatives are products of the slopes of both surveys. The noise of both surveys is independent,
// so noise does not count as relief that would determine the horizontal position. Directions with a
// weight below 1e-4 of the best one are not determined and get no motion: horizontal directions, if
// the root mean square of the slopes along them is below 0.01.
//
// The covariance is that of the normal equations, in which the sums of residuals over cells of the
// map take the place of independent residuals. So it holds for residuals that are correlated over
// distances shorter than a cell, which is 1/20 of the longer side of the map.
//
// `progress` counts the steps, of which there are at most `max_iterations`.
//
// Error if `after` has fewer than 100 vertices over the grid, or if both have surface at fewer than
// 100 samples or in fewer than 12 cells.
Registration register_surveys(const Mesh& before, const Mesh& after, const map::MapFrame& frame,
                              const map::MapGrid& grid, const RegistrationOptions& options = {},
                              const ProgressSink& progress = {});

}  // namespace axial::compare
