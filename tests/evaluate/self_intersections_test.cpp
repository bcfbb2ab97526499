// SPDX-License-Identifier: GPL-3.0-or-later
// Compares with CGAL's check of a half-edge mesh.
#include "evaluate/self_intersections.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "evaluate/shapes.h"

namespace axial::evaluate {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Halfedges = CGAL::Surface_mesh<Kernel::Point_3>;

std::vector<std::uint32_t> by_cgal(const Mesh& mesh) {
  Halfedges halfedges;
  std::vector<Halfedges::Vertex_index> vertices;
  for (const Eigen::Vector3f& x : mesh.vertices)
    vertices.push_back(halfedges.add_vertex(Kernel::Point_3(x.x(), x.y(), x.z())));
  for (const auto& f : mesh.faces)
    halfedges.add_face(vertices[f[0]], vertices[f[1]], vertices[f[2]]);
  std::vector<std::pair<Halfedges::Face_index, Halfedges::Face_index>> pairs;
  CGAL::Polygon_mesh_processing::self_intersections(halfedges, std::back_inserter(pairs));
  std::set<std::uint32_t> faces;
  for (const auto& [a, b] : pairs) faces.insert({a.idx(), b.idx()});
  return {faces.begin(), faces.end()};
}

TEST(SelfIntersections, AgreeWithCgalOnRoughSurfaces) {
  std::mt19937 random(11);
  Mesh smooth = height_field(12, 2, ripples);
  EXPECT_TRUE(self_intersecting_faces(smooth).empty());
  for (const double noise : {0.02, 0.1, 0.3}) {  // cells are 0.17 wide
    Mesh rough = smooth;
    for (Eigen::Vector3f& x : rough.vertices) x += random_vector(random, noise).cast<float>();
    const auto found = self_intersecting_faces(rough);
    EXPECT_EQ(found, by_cgal(rough)) << noise;
    EXPECT_EQ(found.size() > 4, noise > 0.05) << noise;
  }
}

}  // namespace
}  // namespace axial::evaluate
