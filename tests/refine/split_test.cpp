// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/split.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>

#include "refine/topology.h"

namespace axial::refine {
namespace {

// A closed surface: an octahedron.
Mesh octahedron() {
  Mesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.colors.assign(6, Rgb{10, 20, 30});
  mesh.colors[0] = {30, 20, 10};
  mesh.faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

float volume(const Mesh& mesh) {
  float sum = 0;
  for (const auto& [a, b, c] : mesh.faces)
    sum += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6;
  return sum;
}

TEST(Split, EveryChoiceOfFacesKeepsAClosedOrientedSurface) {
  for (unsigned choice = 0; choice < 256; ++choice) {
    Mesh mesh = octahedron();
    std::vector<bool> marked(8);
    std::size_t count = 0;
    for (std::size_t f = 0; f < 8; ++f) count += (marked[f] = choice >> f & 1) ? 1 : 0;
    const std::size_t added = split_faces(mesh, marked);
    EXPECT_EQ(mesh.faces.size(), 8 + added);
    EXPECT_GE(added, 3 * count);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& face : mesh.faces)
      for (std::size_t k = 0; k < 3; ++k) ++edges[{face[k], face[(k + 1) % 3]}];
    for (const auto& [edge, times] : edges) {
      EXPECT_EQ(times, 1) << choice;
      EXPECT_TRUE(edges.count({edge.second, edge.first})) << choice;
    }
    EXPECT_NEAR(volume(mesh), 4.0f / 3, 1e-5f) << choice;
    EXPECT_EQ(mesh.colors.size(), mesh.vertices.size());
  }
}

TEST(Split, NewVerticesHaveTheMeanColour) {
  Mesh mesh = octahedron();
  split_faces(mesh, {true, false, false, false, false, false, false, false});
  EXPECT_EQ(mesh.vertices[6], Eigen::Vector3f(0.5f, 0.5f, 0));
  EXPECT_EQ(mesh.colors[6], (Rgb{20, 20, 20}));
}

TEST(Topology, BordersAreFound) {
  Mesh mesh = octahedron();
  for (const bool border : topology_of(mesh).border) EXPECT_FALSE(border);
  mesh.faces.erase(mesh.faces.begin());
  const Topology topology = topology_of(mesh);
  EXPECT_EQ(topology.border, (std::vector<bool>{true, false, true, false, true, false}));
  EXPECT_EQ(topology.neighbours.of(0).size(), 4u);
}

}  // namespace
}  // namespace axial::refine
