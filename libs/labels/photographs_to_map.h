// SPDX-License-Identifier: GPL-3.0-or-later
// Labels that were drawn in a photograph on the map.
#pragma once

#include <vector>

#include "labels/labelled_surface.h"
#include "labels/posed_rays.h"
#include "map/label_file.h"

namespace axial::labels {

// A label of a photograph on the map.
struct CarriedLabel {
  map::Label label;             // [map]; without parts and points if the map shows none of it
  std::vector<double> heights;  // as LabelFromPhotograph::heights
  double missing = 0;           // share of the label's rays that meet no surface
  double coarseness = 1;  // distance of the samples of the outline / width of a pixel on the map
};

// Carries a label along the rays of its photograph. `drawn`: [px]; a place belongs to its polygon
// if an odd number of rings of a part contain it, so that a ring may run along itself.
//
// A place of the map belongs to the polygon if the photograph shows the highest surface there, not
// hidden by other parts of the mesh, inside the drawn polygon. So a line that was drawn over the
// edge of a colony does not tear: the part behind the edge becomes a part of its own. Of the drawn
// pixels that see one of the parts, a part needs the share `least_part`; others are left out. The
// outline is that of geometry::region_outlines(), with samples as far apart as the pixels lie on
// the surface, in the middle of the label, but with no more than 2,048 along the longer side: so a
// far place makes it coarse. A point lies where its ray meets the surface.
CarriedLabel carried_to_map(const LabelledSurface& surface, const PosedRays& rays,
                            const map::Label& drawn, double least_part);

}  // namespace axial::labels
