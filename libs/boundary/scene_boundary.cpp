// SPDX-License-Identifier: GPL-3.0-or-later
#include "boundary/scene_boundary.h"

#include "axial/map.h"
#include "base/naming.h"
#include "boundary/cut_mesh.h"

namespace axial::boundary {

map::MapPlace place_of_scene(const Options& options, const Mesh& mesh, const SceneFacts& scene) {
  if (!options.map.empty()) return map::place_of_map(options.map);
  const Eigen::Vector3d up =
      scene.frame.is_world()
          ? naming(scene.mesh, [&] { return map::fitted_up(mesh, scene.centres); })
          : Eigen::Vector3d::UnitZ();
  return {map::world_axes(map::frame_with_up(up, scene.frame), scene.frame), ""};
}

std::size_t mark_outside(const Options& options, const SceneFacts& scene, Mesh& mesh,
                         const Context& context) {
  const map::MapPlace place = place_of_scene(options, mesh, scene);
  const Boundary boundary = read_boundary(options, place.axes, place.crs, scene.frame, scene.mesh);
  context.memory().require(bytes_to_mark(mesh), "cutting the mesh at the boundary");
  const std::size_t outside = mark_outside(mesh, boundary);
  context.info("{}: {} faces are inside and {} are left out", boundary.name(),
               mesh.faces.size() - outside, outside);
  return outside;
}

}  // namespace axial::boundary
