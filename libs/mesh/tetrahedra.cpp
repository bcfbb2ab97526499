// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/tetrahedra.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <utility>

#include "base/error.h"

namespace axial::mesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using CellBase =
    CGAL::Triangulation_cell_base_with_info_3<std::uint32_t, Kernel,
                                              CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Delaunay =
    CGAL::Delaunay_triangulation_3<Kernel,
                                   CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;

}  // namespace

Tetrahedra delaunay(std::span<const Eigen::Vector3f> points) {
  std::vector<std::pair<Kernel::Point_3, std::uint32_t>> numbered;
  numbered.reserve(points.size());
  for (const Eigen::Vector3f& point : points)
    numbered.emplace_back(Kernel::Point_3(point.x(), point.y(), point.z()),
                          static_cast<std::uint32_t>(numbered.size()));
  Delaunay triangulation(numbered.begin(), numbered.end());
  if (triangulation.dimension() < 3) fail("the points all lie in a plane");

  triangulation.infinite_vertex()->info() = Tetrahedra::kInfinity;
  std::uint32_t count = 0;
  for (const auto cell : triangulation.all_cell_handles()) cell->info() = count++;

  Tetrahedra result;
  result.corners.reserve(count);
  result.neighbours.reserve(count);
  for (const auto cell : triangulation.all_cell_handles()) {
    Tetrahedra::Four corners, neighbours;
    for (int i = 0; i < 4; ++i) {
      corners[static_cast<std::size_t>(i)] = cell->vertex(i)->info();
      neighbours[static_cast<std::size_t>(i)] = cell->neighbor(i)->info();
    }
    result.corners.push_back(corners);
    result.neighbours.push_back(neighbours);
  }
  return result;
}

}  // namespace axial::mesh
