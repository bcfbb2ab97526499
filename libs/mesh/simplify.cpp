// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include "private/halfedge_mesh.h"

namespace axial::mesh {
namespace {

void round_to_float(HalfedgeMesh& mesh) {
  for (const auto vertex : mesh.vertices()) move_to(mesh, vertex, position(mesh, vertex));
}

}  // namespace

void decimate(HalfedgeMesh& mesh, std::size_t faces) {
  namespace sms = CGAL::Surface_mesh_simplification;
  // The number of edges per face stays nearly the same: a collapse inside the mesh removes two
  // faces and three edges.
  const double edges_per_face =
      static_cast<double>(mesh.number_of_edges()) / static_cast<double>(mesh.number_of_faces());
  const sms::Count_stop_predicate<HalfedgeMesh> stop(
      static_cast<std::size_t>(static_cast<double>(faces) * edges_per_face));
  const sms::GarlandHeckbert_plane_policies<HalfedgeMesh, HalfedgeKernel> policies(mesh);
  sms::edge_collapse(
      mesh, stop,
      CGAL::parameters::get_cost(policies.get_cost()).get_placement(policies.get_placement()));
  mesh.collect_garbage();
  round_to_float(mesh);
}

}  // namespace axial::mesh
