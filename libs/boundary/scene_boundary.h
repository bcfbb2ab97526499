// SPDX-License-Identifier: GPL-3.0-or-later
// The boundary of the mesh of a scene, for programs that make no map.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "base/context.h"
#include "boundary/boundary.h"
#include "map/map_place.h"
#include "scene/mesh.h"

namespace axial::boundary {

// What is known of a scene with a mesh.
struct SceneFacts {
  LocalFrame frame;                      // of the mesh
  std::vector<Eigen::Vector3d> centres;  // of the cameras [frame of the mesh]
  std::filesystem::path mesh;            // its file, or the one beside which it will be
};

// The axes and the reference system in which the boundary is meant: those of Options::map. Without
// such a map they are those of a map of MapSurface with its defaults: heights are along z if the
// frame is not the world, and otherwise along map::fitted_up() of the mesh.
map::MapPlace place_of_scene(const Options& options, const Mesh& mesh, const SceneFacts& scene);

// Reads the boundary and marks the faces of the mesh outside of it (cut_mesh.h). Tells how many
// faces are inside. Returns the number of faces outside. Errors of read_boundary() and
// mark_outside() are passed on; Error if the memory does not suffice.
std::size_t mark_outside(const Options& options, const SceneFacts& scene, Mesh& mesh,
                         const Context& context);

}  // namespace axial::boundary
