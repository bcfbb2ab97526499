// SPDX-License-Identifier: GPL-3.0-or-later
// Evidence of free and occupied space, as capacities of an s-t cut between the tetrahedra. The
// weights are those of Labatut, Pons and Keriven, "Robust and efficient surface reconstruction from
// range data", Computer Graphics Forum 28(8), 2009.
#pragma once

#include <cstddef>

#include "axial/mesh.h"
#include "base/context.h"
#include "mesh/merge_points.h"
#include "mesh/tetrahedra.h"
#include "mesh/view_rays.h"
#include "mesh/votes.h"

namespace axial::mesh {

// The expected error [m] of the merged point number i along its rays: `options.thickness_factor`
// times 2.5 times MergedPoints::pixel_widths. It is `sigma` in the comment of cast_votes().
double expected_error(const MergedPoints& points, std::size_t i, const VoteOptions& options);

// Casts the votes of all rays between `points` and the cameras of their views. `tetrahedra` is
// delaunay() of the positions of `points`. Points that are no corner, because another point is at
// the same place, cast no votes. A view that does not see its point casts none. Let d [m] be the
// distance along a ray from its point, sigma the expected_error() of the point, and w the weight of
// the view (see VoteOptions::constant_weight). Each ray casts these votes:
//
// * The cost of each facet that the ray crosses in front of the point, with the free side towards
//   the camera, rises by w * (1 - exp(-d^2 / (2 sigma^2))). The same holds for the facets behind
//   the point, up to d = sigma.
// * The tetrahedron at the camera's end of the ray gets 100000 votes for outside, so that it is
//   certainly free.
// * The tetrahedron one sigma behind the point gets w votes for inside.
//
// With `weak_support` further votes for inside follow (weak_support.h). At last the cost of each
// facet rises by quality_factor times shape_cost() (facet_quality.h), so that surfaces through well
// shaped tetrahedra are preferred. `context` gets the number of points whose rays have been cast.
Votes cast_votes(const Tetrahedra& tetrahedra, const MergedPoints& points, const ViewRays& rays,
                 const VoteOptions& options = {}, const Context& context = {});

}  // namespace axial::mesh
