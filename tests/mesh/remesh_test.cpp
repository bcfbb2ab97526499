// SPDX-License-Identifier: GPL-3.0-or-later
// Remeshing of meshes that are as bad as meshes get: with borders, holes, several components,
// faces without area and vertices at the same place.
#include <gmock/gmock.h>

#include <random>

#include "base/error.h"
#include "evaluate/self_intersections.h"
#include "mesh/clean.h"
#include "topology.h"

namespace axial::mesh {
namespace {

class Chance {
 public:
  explicit Chance(unsigned seed) : random_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  bool happens(double probability) { return between(0, 1) < probability; }

 private:
  std::mt19937 random_;
};

// Appends a grid of `size` x `size` squares of side 1 with noise and holes. Of its vertices, some
// lie exactly between their neighbours, and some at the place of a neighbour.
void append_grid(Mesh& mesh, std::uint32_t size, double shift, Chance& chance) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const double noise = chance.happens(0.3) ? 0 : std::pow(10, chance.between(-2, -0.2));
  const double holes = chance.happens(0.4) ? 0 : chance.between(0, 0.3);
  const double flat = chance.happens(0.5) ? 0 : chance.between(0, 0.4);
  for (std::uint32_t y = 0; y <= size; ++y)
    for (std::uint32_t x = 0; x <= size; ++x) {
      const std::size_t count = mesh.vertices.size();
      Eigen::Vector3d at(x + noise * chance.between(-1, 1), y + noise * chance.between(-1, 1),
                         shift + noise * chance.between(-1, 1));
      if (x > 1 && chance.happens(flat))  // the next ones on the line of the last two
        at = (2 * mesh.vertices[count - 1] - mesh.vertices[count - 2]).cast<double>();
      if (x > 0 && chance.happens(0.1 * flat)) at = mesh.vertices[count - 1].cast<double>();
      mesh.vertices.push_back(at.cast<float>());
    }
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x) {
      const std::uint32_t a = first + y * (size + 1) + x, b = a + 1, c = a + size + 1, d = c + 1;
      if (!chance.happens(holes)) mesh.faces.push_back({a, b, d});
      if (!chance.happens(holes)) mesh.faces.push_back({a, d, c});
    }
}

struct Case {
  Mesh mesh;
  CleanOptions options;
};

Case random_case(unsigned seed) {
  Chance chance(seed);
  Case made;
  const auto size = static_cast<std::uint32_t>(chance.between(3, 14));
  const int components = chance.happens(0.3) ? 3 : 1;
  for (int i = 0; i < components; ++i) append_grid(made.mesh, size, 2.0 * i, chance);
  const double scale = std::pow(10, chance.between(-3, 3));
  for (Eigen::Vector3f& vertex : made.mesh.vertices) vertex *= static_cast<float>(scale);
  made.options.spurious = made.options.cut_off = chance.happens(0.5) ? 0 : chance.between(0, 5);
  made.options.spikes = chance.happens(0.5);
  made.options.close_holes = chance.happens(0.5) ? 0 : 8;
  // From a fifth of the edges to a hundred of them; sometimes far less, which is refused.
  made.options.edge_length =
      scale * (chance.happens(0.05) ? 1e-6 : std::pow(10, chance.between(-0.7, 2)));
  return made;
}

void expect_clean(const Mesh& mesh, unsigned seed) {
  const test::MeshFacts facts = test::facts_of(mesh);
  EXPECT_GT(mesh.faces.size(), 0u) << seed;
  EXPECT_EQ(facts.bad_edges, 0u) << seed;
  EXPECT_EQ(facts.bad_vertices, 0u) << seed;
  EXPECT_EQ(facts.unused_vertices, 0u) << seed;
  for (const Eigen::Vector3f& vertex : mesh.vertices) ASSERT_TRUE(vertex.allFinite()) << seed;
  for (const auto& face : mesh.faces) ASSERT_FALSE(evaluate::is_degenerate(mesh, face)) << seed;
  EXPECT_TRUE(evaluate::self_intersecting_faces(mesh).empty()) << seed;
}

constexpr unsigned kCases = 200;

TEST(Remesh, EveryMeshIsCleanedOrRefused) {
  unsigned refused = 0;
  for (unsigned seed = 0; seed < kCases; ++seed) {
    const Case made = random_case(seed);
    try {
      expect_clean(clean(made.mesh, made.options), seed);
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << seed;
    }
  }
  EXPECT_LT(refused, kCases / 2);
}

// A face without area whose edges are split many times: CGAL's relaxation reads outside of its
// arrays at the new vertices.
TEST(Remesh, FacesWithoutAreaAreSplit) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {8, 0, 0}, {4, 0, 0}, {0, 4, 0}, {8, 4, 0}};
  mesh.faces = {{0, 1, 2}, {0, 4, 1}, {0, 3, 4}};  // the first one is flat
  CleanOptions options;
  options.spurious = 0;
  options.spikes = false;
  options.close_holes = 0;
  options.edge_length = 0.25;
  expect_clean(clean(mesh, options), 0);
}

}  // namespace
}  // namespace axial::mesh
