// SPDX-License-Identifier: GPL-3.0-or-later
// Labels of one object that were drawn in several photographs, as one label on the map.
#pragma once

#include <vector>

#include "labels/labelled_surface.h"
#include "map/label_file.h"

namespace axial::labels {

// Which labels are of one object. Labels of different classes never are.
enum class Join {
  none,
  name,    // those with the same name, which is not that of the class
  overlap  // those that overlap on the map, and those that both overlap with a third one
};

struct JoinOptions {
  Join join = Join::none;
  double least_overlap = 0.5;  // for Join::overlap: the share of the smaller polygon
};

// Unites the polygons of each object; labels with points stay as they are. A united label stands at
// the place of its first one, has its name, and names all photographs, with "; " between them. Its
// heights are those of the surface. Labels that are joined with no other one are not changed.
// `labels`: polygons or points [map]. Errors of map::united().
std::vector<map::LabelFromPhotograph> joined_labels(const LabelledSurface& surface,
                                                    std::vector<map::LabelFromPhotograph> labels,
                                                    const JoinOptions& options);

}  // namespace axial::labels
