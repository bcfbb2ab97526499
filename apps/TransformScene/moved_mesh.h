// SPDX-License-Identifier: GPL-3.0-or-later
// The mesh after the transformation, for volumes and for points on it.
#pragma once

#include <filesystem>

#include "base/context.h"
#include "options.h"
#include "scene/mesh.h"
#include "scene/moved_scene.h"

namespace axial::apps {

// Returns Options::mesh in move.to. Error that names the file for a malformed file and for a mesh
// without faces.
Mesh moved_mesh(const Options& options, const FrameMove& move, const Context& context);

// The file of the points on the mesh: <output without extension>_samples.ply.
std::filesystem::path samples_file(const Options& options);

// Writes random points on the moved mesh, uniform by area, to `file`. Options::sample_mesh below 0:
// minus the number of points; above 0: points for each square unit of area. Error that names the
// option for more than 10^8 points, and Errors of moved_mesh() and geometry::sample_surface().
void write_samples(const Options& options, const FrameMove& move, const std::filesystem::path& file,
                   const Context& context);

}  // namespace axial::apps
