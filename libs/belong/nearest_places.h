// SPDX-License-Identifier: GPL-3.0-or-later
// The nearest points of a large shape to a few places.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "belong/shape.h"

namespace axial::belong {

// Returns, for each place, the point of the shape that is nearest to it, or nothing if no point of
// the shape lies within `reach` of the place. Points lie anywhere on the faces of a mesh. Needs
// memory for the places alone, and time in proportion to the parts of the shape. Faces that are
// much larger than `reach` take more time. The result does not depend on the number of threads.
// Preconditions: places are finite, and `reach` is positive and finite.
std::vector<std::optional<Eigen::Vector3d>> nearest_places(const Shape& shape,
                                                           std::span<const Eigen::Vector3d> places,
                                                           double reach);

}  // namespace axial::belong
