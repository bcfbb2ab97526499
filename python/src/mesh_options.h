// SPDX-License-Identifier: GPL-3.0-or-later
// What the stages of meshes share.
#pragma once

#include "axial/mesh.h"
#include "src/keywords.h"

namespace axial::python {

void add_cleaning_keywords(Keywords& keywords, mesh::CleanOptions& options);

}  // namespace axial::python
