// SPDX-License-Identifier: GPL-3.0-or-later
// Mends and simplifies a triangle mesh: clean() in axial/mesh.h.
#pragma once

#include <cstdint>

#include "axial/mesh.h"

namespace axial::mesh {

// An estimate of the memory [bytes] of clean() with its result, besides `mesh`, if the mesh is not
// remeshed to more vertices.
std::uint64_t bytes_to_clean(std::uint64_t vertices);

}  // namespace axial::mesh
