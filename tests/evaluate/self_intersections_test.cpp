// SPDX-License-Identifier: GPL-3.0-or-later
// Compares with a comparison of all pairs of faces by signed volumes. The corners are random, so no
// volume is so small that rounding could change its sign.
#include "evaluate/self_intersections.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "evaluate/shapes.h"

namespace axial::evaluate {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;
using Segment = std::array<Eigen::Vector3d, 2>;

bool positive_volume(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                     const Eigen::Vector3d& d) {
  return (b - a).cross(c - a).dot(d - a) > 0;
}

// The ends lie on different sides of the triangle's plane, and the line through them passes all
// three edges on the same side.
bool cross(const Segment& s, const Corners& t) {
  if (positive_volume(t[0], t[1], t[2], s[0]) == positive_volume(t[0], t[1], t[2], s[1]))
    return false;
  const bool side = positive_volume(s[0], s[1], t[0], t[1]);
  return side == positive_volume(s[0], s[1], t[1], t[2]) &&
         side == positive_volume(s[0], s[1], t[2], t[0]);
}

// True if an edge of the face `a` crosses the face `b`. Edges that end in a vertex of `b` are
// skipped: they meet `b` there.
bool edge_crosses(const Mesh& mesh, const std::array<std::uint32_t, 3>& a,
                  const std::array<std::uint32_t, 3>& b) {
  const auto at = [&](std::uint32_t v) { return mesh.vertices[v].cast<double>().eval(); };
  const auto in_b = [&](std::uint32_t v) { return std::ranges::count(b, v) > 0; };
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t p = a[i], q = a[(i + 1) % 3];
    if (!in_b(p) && !in_b(q) && cross({at(p), at(q)}, {at(b[0]), at(b[1]), at(b[2])})) return true;
  }
  return false;
}

std::vector<std::uint32_t> by_all_pairs(const Mesh& mesh) {
  std::set<std::uint32_t> found;
  for (std::uint32_t i = 0; i < mesh.faces.size(); ++i)
    for (std::uint32_t j = 0; j < mesh.faces.size(); ++j)
      if (i != j && edge_crosses(mesh, mesh.faces[i], mesh.faces[j])) found.insert({i, j});
  return {found.begin(), found.end()};
}

TEST(SelfIntersections, AgreeWithAllPairsOnRoughSurfaces) {
  std::mt19937 random(11);
  Mesh smooth = height_field(12, 2, ripples);
  EXPECT_TRUE(self_intersecting_faces(smooth).empty());
  for (const double noise : {0.02, 0.1, 0.3}) {  // cells are 0.17 wide
    Mesh rough = smooth;
    for (Eigen::Vector3f& x : rough.vertices) x += random_vector(random, noise).cast<float>();
    const auto found = self_intersecting_faces(rough);
    EXPECT_EQ(found, by_all_pairs(rough)) << noise;
    EXPECT_EQ(found.size() > 4, noise > 0.05) << noise;
  }
}

// The special positions, which random corners do not have.
TEST(SelfIntersections, CoverTouchingAndFoldedFaces) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0},         {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                   {0.25F, 0.25F, 0}, {0, 0, 1}, {1, 0, 1}};
  const auto intersect = [&](std::array<std::uint32_t, 3> a, std::array<std::uint32_t, 3> b) {
    mesh.faces = {a, b};
    return !self_intersecting_faces(mesh).empty();
  };
  EXPECT_FALSE(intersect({0, 1, 2}, {1, 3, 2}));  // one plane, both sides of the edge
  EXPECT_TRUE(intersect({0, 1, 2}, {1, 4, 2}));   // one plane, the same side of the edge
  EXPECT_TRUE(intersect({0, 1, 2}, {4, 5, 6}));   // a corner lies on the other face
  EXPECT_FALSE(intersect({0, 1, 2}, {0, 5, 6}));  // only the common vertex
  EXPECT_TRUE(intersect({0, 1, 2}, {2, 1, 0}));   // the same face twice
}

}  // namespace
}  // namespace axial::evaluate
