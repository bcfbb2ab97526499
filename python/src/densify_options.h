// SPDX-License-Identifier: GPL-3.0-or-later
// The keywords of densify().
#pragma once

#include "axial/densify.h"
#include "src/keywords.h"

namespace axial::python {

// Adds a keyword for each field of `options`, except the job and the paths of the scene. The
// keyword is the name of the field. The name of a group stands before the names of its fields if
// the field alone has no clear meaning: resolution_level, speckles_min_pixels.
void add_keywords(Keywords& keywords, densify::Options& options);

}  // namespace axial::python
