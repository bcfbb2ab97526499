// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/topology.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "base/error.h"
#include "evaluate/self_intersections.h"
#include "evaluate/shapes.h"

namespace axial::evaluate {
namespace {

Mesh cube() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back(static_cast<float>(i & 1), static_cast<float>((i >> 1) & 1),
                               static_cast<float>(i >> 2));
  mesh.faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

// Adds a cube moved by `by`. Vertices at the same position become one.
Mesh two_cubes(const Eigen::Vector3f& by) {
  Mesh mesh = cube();
  const Mesh other = cube();
  for (const auto& face : other.faces) {
    std::array<std::uint32_t, 3> added{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3f x = other.vertices[face[k]] + by;
      const auto found = std::find(mesh.vertices.begin(), mesh.vertices.end(), x);
      added[k] = static_cast<std::uint32_t>(found - mesh.vertices.begin());
      if (found == mesh.vertices.end()) mesh.vertices.push_back(x);
    }
    mesh.faces.push_back(added);
  }
  return mesh;
}

// A band of `steps` squares with half a turn.
Mesh moebius_strip(std::uint32_t steps) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < steps; ++i)
    for (const double side : {-0.3, 0.3}) {
      const double turn = 2 * std::numbers::pi * i / steps;
      const double radius = 1 + side * std::cos(turn / 2);
      mesh.vertices.push_back(Eigen::Vector3d(radius * std::cos(turn), radius * std::sin(turn),
                                              side * std::sin(turn / 2))
                                  .cast<float>());
    }
  for (std::uint32_t i = 0; i < steps; ++i) {
    const std::uint32_t a = 2 * i, b = a + 1;
    const bool last = i + 1 == steps;  // the sides change places
    const std::uint32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    mesh.faces.push_back({a, c, b});
    mesh.faces.push_back({b, c, d});
  }
  return mesh;
}

// The whole as the definitions in topology.h say it, from sets and without any order.
class Oracle {
 public:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;

  explicit Oracle(const Mesh& mesh) : faces_(mesh.faces) {
    for (const auto& face : faces_)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = face[k], to = face[(k + 1) % 3];
        ++edges_[std::minmax(from, to)];
        ++passed_[{from, to}];
      }
  }

  Topology topology() const {
    Topology t;
    t.faces = faces_.size();
    t.edges = edges_.size();
    std::vector<std::set<std::uint32_t>> border, faces;
    std::set<std::uint32_t> used;
    for (const auto& [edge, count] : edges_) {
      if (count > 2) ++t.non_manifold_edges;
      if (count == 2 && passed(edge.first, edge.second) != 1) ++t.inconsistent_edges;
      if (count != 1) continue;
      ++t.border_edges;
      border.push_back({edge.first, edge.second});
    }
    t.border_loops = merged(border);
    std::vector<std::set<Edge>> parts;
    for (const auto& face : faces_) {
      used.insert(face.begin(), face.end());
      parts.push_back({});
      for (std::size_t k = 0; k < 3; ++k)
        parts.back().insert(std::minmax(face[k], face[(k + 1) % 3]));
    }
    t.components = merged(parts);
    t.vertices = used.size();
    for (const std::uint32_t vertex : used)
      if (!is_fan(vertex)) ++t.non_manifold_vertices;
    return t;
  }

 private:
  // The number of sets after sets with a common element became one.
  template <class Set>
  static std::size_t merged(std::vector<Set> sets) {
    for (std::size_t i = 0; i < sets.size(); ++i)
      for (std::size_t j = i + 1; j < sets.size();) {
        const bool meet =
            std::ranges::any_of(sets[j], [&](const auto& x) { return sets[i].contains(x); });
        if (!meet) {
          ++j;
          continue;
        }
        sets[i].insert(sets[j].begin(), sets[j].end());
        sets.erase(sets.begin() + static_cast<std::ptrdiff_t>(j));
        j = i + 1;
      }
    return sets.size();
  }

  int passed(std::uint32_t from, std::uint32_t to) const {
    const auto found = passed_.find({from, to});
    return found == passed_.end() ? 0 : found->second;
  }

  // The edges opposite to the vertex form one chain, open or closed.
  bool is_fan(std::uint32_t vertex) const {
    std::vector<std::set<std::uint32_t>> opposite;
    std::map<std::uint32_t, int> ends;
    for (const auto& face : faces_) {
      if (std::ranges::find(face, vertex) == face.end()) continue;
      opposite.push_back({});
      for (const std::uint32_t corner : face)
        if (corner != vertex) {
          opposite.back().insert(corner);
          ++ends[corner];
        }
    }
    return merged(opposite) == 1 &&
           std::ranges::all_of(ends, [](const auto& end) { return end.second <= 2; });
  }

  std::vector<std::array<std::uint32_t, 3>> faces_;
  std::map<Edge, int> edges_, passed_;
};

void expect_agrees_with_oracle(const Mesh& mesh) {
  const Topology t = topology_of(mesh), expected = Oracle(mesh).topology();
  EXPECT_EQ(t.vertices, expected.vertices);
  EXPECT_EQ(t.faces, expected.faces);
  EXPECT_EQ(t.edges, expected.edges);
  EXPECT_EQ(t.non_manifold_edges, expected.non_manifold_edges);
  EXPECT_EQ(t.non_manifold_vertices, expected.non_manifold_vertices);
  EXPECT_EQ(t.border_edges, expected.border_edges);
  EXPECT_EQ(t.border_loops, expected.border_loops);
  EXPECT_EQ(t.components, expected.components);
  EXPECT_EQ(t.inconsistent_edges, expected.inconsistent_edges);
}

TEST(Topology, ACubeIsAClosedSurface) {
  const Topology t = topology_of(cube());
  EXPECT_EQ(t.vertices, 8u);
  EXPECT_EQ(t.edges, 18u);
  EXPECT_EQ(t.faces, 12u);
  EXPECT_EQ(t.components, 1u);
  EXPECT_EQ(t.border_edges + t.border_loops + t.non_manifold_edges + t.non_manifold_vertices +
                t.inconsistent_edges + t.degenerate_faces + t.self_intersecting_faces,
            0u);
}

TEST(Topology, AMissingFaceIsALoopOfThreeEdges) {
  Mesh mesh = cube();
  mesh.faces.pop_back();
  Topology t = topology_of(mesh);
  EXPECT_EQ(t.border_edges, 3u);
  EXPECT_EQ(t.border_loops, 1u);
  EXPECT_EQ(t.non_manifold_vertices, 0u);
  mesh.faces.erase(mesh.faces.begin());  // {0, 2, 1} has no vertex in common with {3, 7, 5}
  t = topology_of(mesh);
  EXPECT_EQ(t.border_edges, 6u);
  EXPECT_EQ(t.border_loops, 2u);
  expect_agrees_with_oracle(mesh);
}

TEST(Topology, CubesThatShareAnEdgeAreNotManifoldThere) {
  const Mesh mesh = two_cubes({1, 1, 0});
  const Topology t = topology_of(mesh);
  EXPECT_EQ(t.vertices, 14u);
  EXPECT_EQ(t.non_manifold_edges, 1u);
  EXPECT_EQ(t.non_manifold_vertices, 2u);
  EXPECT_EQ(t.components, 1u);
  EXPECT_EQ(t.border_edges, 0u);
  EXPECT_EQ(t.self_intersecting_faces, 0u);
  expect_agrees_with_oracle(mesh);
}

TEST(Topology, CubesThatShareAVertexAreTwoFansThere) {
  const Mesh mesh = two_cubes({1, 1, 1});
  const Topology t = topology_of(mesh);
  EXPECT_EQ(t.non_manifold_edges, 0u);
  EXPECT_EQ(t.non_manifold_vertices, 1u);
  EXPECT_EQ(t.components, 2u);
  EXPECT_EQ(t.self_intersecting_faces, 0u);
  expect_agrees_with_oracle(mesh);
}

TEST(Topology, AFlippedFaceHasThreeInconsistentEdges) {
  Mesh mesh = cube();
  std::swap(mesh.faces[4][0], mesh.faces[4][1]);
  const Topology t = topology_of(mesh);
  EXPECT_EQ(t.inconsistent_edges, 3u);
  EXPECT_EQ(t.non_manifold_vertices, 0u);
  expect_agrees_with_oracle(mesh);
}

TEST(Topology, AMoebiusStripHasOneBorderAndNoOrientation) {
  const Mesh mesh = moebius_strip(20);
  const Topology t = topology_of(mesh);
  EXPECT_EQ(t.border_edges, 40u);
  EXPECT_EQ(t.border_loops, 1u);
  EXPECT_EQ(t.inconsistent_edges, 1u);
  EXPECT_EQ(t.non_manifold_vertices, 0u);
  EXPECT_EQ(t.self_intersecting_faces, 0u);
  expect_agrees_with_oracle(mesh);
}

TEST(Topology, RandomFacesAgreeWithTheDefinitions) {
  std::mt19937 random(3);
  for (int run = 0; run < 20; ++run) {
    Mesh mesh;
    for (int i = 0; i < 12; ++i) mesh.vertices.push_back(random_vector(random, 1).cast<float>());
    std::uniform_int_distribution<std::uint32_t> vertex(0, 11);
    while (mesh.faces.size() < 3 + static_cast<std::size_t>(run)) {
      const std::array<std::uint32_t, 3> face{vertex(random), vertex(random), vertex(random)};
      if (face[0] != face[1] && face[1] != face[2] && face[0] != face[2])
        mesh.faces.push_back(face);
    }
    expect_agrees_with_oracle(mesh);
  }
}

TEST(Topology, DegenerateFacesCountOnlyAsSuch) {
  Mesh mesh = cube();
  mesh.vertices.emplace_back(0.5f, 0.0f, 0.0f);  // on the edge from 0 to 1
  mesh.faces.push_back({0, 8, 1});
  mesh.faces.push_back({3, 3, 5});
  mesh.vertices.push_back(mesh.vertices[2]);
  mesh.faces.push_back({2, 9, 7});
  const Topology t = topology_of(mesh);
  EXPECT_EQ(t.degenerate_faces, 3u);
  EXPECT_EQ(t.faces, 12u);
  EXPECT_EQ(t.vertices, 8u);
  EXPECT_EQ(t.edges, 18u);
  EXPECT_EQ(t.border_edges + t.non_manifold_edges, 0u);
}

TEST(Topology, CrossingTrianglesIntersect) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0.5f, 0.5f, -1}, {0.5f, 0.5f, 1}, {3, 3, 0}};
  mesh.faces = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(self_intersecting_faces(mesh), (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(topology_of(mesh).components, 2u);
  mesh.vertices[3].x() = mesh.vertices[4].x() = 1.75f;  // beside the first triangle
  EXPECT_TRUE(self_intersecting_faces(mesh).empty());
}

TEST(Topology, NeighboursIntersectOnlyBesideTheirCommonPart) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.2f, 0.4f, 0}, {0.6f, 0.6f, 1}};
  mesh.faces = {{0, 1, 2}, {1, 3, 2}};
  EXPECT_TRUE(self_intersecting_faces(mesh).empty()) << "a common edge";
  mesh.faces = {{0, 1, 2}, {2, 1, 4}};
  EXPECT_EQ(self_intersecting_faces(mesh).size(), 2u) << "folded onto each other";
  mesh.faces = {{0, 1, 2}, {2, 5, 3}};
  EXPECT_TRUE(self_intersecting_faces(mesh).empty()) << "a common vertex";
  mesh.vertices.emplace_back(0.1f, 0.1f, -1.0f);
  mesh.faces = {{0, 1, 2}, {2, 6, 5}};
  EXPECT_EQ(self_intersecting_faces(mesh).size(), 2u) << "the opposite edge passes through";
  mesh.faces = {{0, 1, 2}, {1, 0, 2}};
  EXPECT_EQ(self_intersecting_faces(mesh).size(), 2u) << "front and back";
}

TEST(Topology, RefusesWrongMeshes) {
  Mesh mesh = cube();
  mesh.faces.push_back({0, 1, 8});
  EXPECT_THROW(topology_of(mesh), Error);
  mesh = cube();
  mesh.vertices[3].x() = std::numeric_limits<float>::infinity();
  EXPECT_THROW(topology_of(mesh), Error);
}

}  // namespace
}  // namespace axial::evaluate
