// SPDX-License-Identifier: GPL-3.0-or-later
// The photographs of a survey, as texturing reads them.
#pragma once

#include "axial/texture.h"
#include "survey/photographs.h"

namespace axial::texture {

// Reads the photographs in colours. `photographs` must outlive the result. An Error of the result
// names the file of the photograph or mask.
ImageSource source_of(const survey::Photographs& photographs);

}  // namespace axial::texture
