// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "mesh/tetrahedra.h"

namespace axial::mesh {

// The cost (0 to 1) of a surface through the facet opposite of corner number `facet` (0 to 3) of
// the tetrahedron `cell`. Two tetrahedra share the facet. `points` are the points of which
// `tetrahedra` is made. Let phi be the larger of the two angles between the facet and the
// circumspheres of these tetrahedra. The cost is 1 - cos(phi) (Labatut, Pons and Keriven 2009,
// "beta-skeleton quality"). The cost is near 0 for a facet that is small compared with both
// spheres, and 1 if the plane of the facet contains the centre of one of the spheres. For an
// infinite tetrahedron the cosine is taken as 1, and for a flat tetrahedron as 0.5.
double shape_cost(const Tetrahedra& tetrahedra, std::span<const Eigen::Vector3f> points,
                  std::size_t cell, std::size_t facet);

}  // namespace axial::mesh
