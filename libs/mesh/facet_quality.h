// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "mesh/tetrahedra.h"

namespace axial::mesh {

// The cost of a surface through the facet opposite of corner `facet` of `cell`: 1 - cos(phi), where
// phi is the larger of the angles between the facet and the circumspheres of the two tetrahedra
// beside it (Labatut, Pons and Keriven 2009, "beta-skeleton quality"). From 0, for a facet that
// halves both spheres' surfaces, to 1. The cosine of an infinite tetrahedron is 1, that of a flat
// tetrahedron 0.5.
double shape_cost(const Tetrahedra& tetrahedra, std::span<const Eigen::Vector3f> points,
                  std::size_t cell, std::size_t facet);

}  // namespace axial::mesh
