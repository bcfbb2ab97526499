// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/clean.h"

#include <Eigen/Geometry>

#include "base/error.h"
#include "support/error_of.h"
#include "topology.h"
#include "worlds/height_field.h"

namespace axial::mesh {
namespace {

using test::append;
using test::error_of;

// A grid of size x size squares of side 1, halved into triangles, in the plane z = 0.
Mesh grid(std::uint32_t size, const Eigen::Vector3f& origin = Eigen::Vector3f::Zero()) {
  Mesh mesh = test::height_field({0, 0}, Eigen::Vector2d::Constant(size), size,
                                 [](double, double) { return 0.0; });
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex += origin;
  return mesh;
}

CleanOptions nothing() {
  CleanOptions options;
  options.spurious = 0;
  options.spikes = false;
  options.close_holes = 0;
  options.smooth = 0;
  options.cut_off = 0;
  return options;
}

double area(const Mesh& mesh) {
  double sum = 0;
  for (const auto& face : mesh.faces) {
    const Eigen::Vector3f a = mesh.vertices[face[1]] - mesh.vertices[face[0]],
                          b = mesh.vertices[face[2]] - mesh.vertices[face[0]];
    sum += 0.5 * static_cast<double>(a.cross(b).norm());
  }
  return sum;
}

TEST(Clean, AGoodMeshStays) {
  const Mesh mesh = grid(10);
  CleanOptions options;
  options.close_holes = 30;  // the border has 40 edges
  options.spurious = 5;
  options.spikes = false;  // corners of the grid
  const Mesh cleaned = clean(mesh, options);
  EXPECT_EQ(cleaned.vertices, mesh.vertices);
  EXPECT_EQ(cleaned.faces.size(), mesh.faces.size());
  EXPECT_DOUBLE_EQ(area(cleaned), 100);
}

TEST(Clean, SmallPiecesAreRemoved) {
  Mesh mesh = grid(30);
  append(mesh, grid(3, {0, 0, 50}));
  CleanReport report;
  CleanOptions options = nothing();
  options.spurious = 20;
  EXPECT_EQ(clean(mesh, options, &report).faces.size(), 1800u);
  EXPECT_EQ(report.removed_components, 1u);
  options.spurious = 3;
  EXPECT_EQ(clean(mesh, options).faces.size(), 1818u);
}

TEST(Clean, SpikesAreRemoved) {
  Mesh mesh = grid(4);
  mesh.vertices.emplace_back(2, -1, 0);
  mesh.faces.push_back({1, 25, 2});  // below the lowest row: hangs by one edge
  CleanOptions options = nothing();
  EXPECT_EQ(clean(mesh, options).faces.size(), 33u);
  options.spikes = true;
  // The two corner faces of a grid also have two border edges.
  CleanReport report;
  const std::size_t faces = clean(mesh, options, &report).faces.size();
  EXPECT_EQ(report.removed_spikes, 3u);
  EXPECT_EQ(faces, 30u);
}

TEST(Clean, HolesUpToTheLimitAreClosed) {
  Mesh mesh = grid(12);
  // Without the two faces of a square in the middle: a hole of four edges.
  mesh.faces.erase(mesh.faces.begin() + 2 * (6 * 12 + 6), mesh.faces.begin() + 2 * (6 * 12 + 7));
  CleanOptions options = nothing();
  options.close_holes = 3;
  EXPECT_DOUBLE_EQ(area(clean(mesh, options)), 143);
  options.close_holes = 4;
  CleanReport report;
  const Mesh closed = clean(mesh, options, &report);
  EXPECT_NEAR(area(closed), 144, 1e-6);
  EXPECT_EQ(report.closed_holes, 1u);
  EXPECT_EQ(test::facts_of(closed).border_edges, 48u);
}

TEST(Clean, EdgesOfThreeFacesAndReversedFacesAreMended) {
  Mesh mesh = grid(4);
  mesh.vertices.emplace_back(2.5f, 2.f, 1.f);
  mesh.faces.push_back({12, 13, 25});  // stands on an edge in the middle
  std::swap(mesh.faces[3][0], mesh.faces[3][1]);
  const test::MeshFacts facts = test::facts_of(clean(mesh, nothing()));
  EXPECT_EQ(facts.bad_edges, 0u);
  EXPECT_EQ(facts.bad_vertices, 0u);
}

// Two sheets at the same place would intersect each other, and both would be removed.
TEST(Clean, RepeatedFacesAreDropped) {
  const Mesh once = grid(4);
  for (const bool reversed : {false, true}) {
    Mesh twice = once;
    for (const auto& [a, b, c] : once.faces)
      twice.faces.push_back(reversed ? std::array{c, b, a} : std::array{b, c, a});
    const Mesh cleaned = clean(twice, nothing());
    EXPECT_EQ(cleaned.vertices.size(), once.vertices.size());
    EXPECT_EQ(cleaned.faces.size(), once.faces.size());
    EXPECT_EQ(test::facts_of(cleaned).bad_edges, 0u);
  }
}

TEST(Clean, TwoSheetsThatTouchAtACornerArePulledApart) {
  // Two tetrahedra with a common corner.
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  for (const auto& [a, b, c, d] : {std::array<std::uint32_t, 4>{0, 1, 2, 3}, {0, 5, 4, 6}}) {
    mesh.faces.push_back({a, c, b});
    mesh.faces.push_back({a, b, d});
    mesh.faces.push_back({a, d, c});
    mesh.faces.push_back({b, c, d});
  }
  CleanReport report;
  CleanOptions options = nothing();
  options.spikes = true;
  const Mesh cleaned = clean(mesh, options, &report);
  EXPECT_EQ(cleaned.faces.size(), 8u);
  EXPECT_EQ(cleaned.vertices.size(), 8u);
  EXPECT_EQ(test::facts_of(cleaned).bad_vertices, 0u);
  EXPECT_EQ(report.removed_intersections, 0u);
}

// A floor and a wall that cross each other in the line y = `y`, z = 0.
Mesh floor_and_wall(float y) {
  Mesh mesh = grid(12);
  Mesh wall = grid(12);
  for (Eigen::Vector3f& v : wall.vertices) v = {v.x() + 0.3f, y, v.y() - 6.2f};
  append(mesh, wall);
  return mesh;
}

TEST(Clean, FacesThatCrossAreRemoved) {
  const Mesh mesh = floor_and_wall(6.4f);
  CleanReport report;
  const Mesh cleaned = clean(mesh, nothing(), &report);
  EXPECT_GT(report.removed_intersections, 0u);
  CleanReport again;
  EXPECT_EQ(clean(cleaned, nothing(), &again).faces.size(), cleaned.faces.size());
  EXPECT_EQ(again.removed_intersections, 0u);
}

TEST(Clean, SmallPiecesThatAreCutOffAreRemoved) {
  const Mesh mesh = floor_and_wall(9.4f);
  CleanOptions options = nothing();
  const Mesh pieces = clean(mesh, options);
  const auto beyond = [](const Mesh& of) {  // vertices of the floor behind the wall
    return std::ranges::count_if(of.vertices, [](const auto& v) { return v.y() > 11; });
  };
  EXPECT_GT(beyond(pieces), 0);
  options.cut_off = 20;
  CleanReport report;
  const Mesh cleaned = clean(mesh, options, &report);
  EXPECT_GT(report.removed_components, 0u);
  EXPECT_EQ(beyond(cleaned), 0);
  // The largest piece of each sheet stays, although it is smaller than 20 edges, too: three
  // quarters of the floor and half of the wall.
  EXPECT_GT(area(cleaned), 0.5 * area(pieces));
  options.cut_off = 1;
  EXPECT_EQ(clean(mesh, options).faces.size(), pieces.faces.size());
}

TEST(Clean, PiecesThatFallBelowTheLimitAreRemoved) {
  // Each sheet has a diagonal of 14.9 mean edges, and the pieces of a sheet at most 12.
  Mesh mesh = floor_and_wall(6.4f);
  append(mesh, grid(30, {0, 0, 50}));
  CleanOptions options = nothing();
  options.spurious = 14;
  CleanReport report;
  const Mesh cleaned = clean(mesh, options, &report);
  EXPECT_GT(report.removed_intersections, 0u);
  EXPECT_TRUE(std::ranges::all_of(cleaned.vertices, [](const auto& v) { return v.z() == 50; }));
  EXPECT_GT(area(cleaned), 890);  // 900 without the spikes at two corners
  options.spurious = 15;
  EXPECT_EQ(clean(mesh, options, &report).faces.size(), 1800u);
  EXPECT_EQ(report.removed_intersections, 0u);
}

TEST(Clean, SmoothingDampsNoiseAndKeepsThePlace) {
  Mesh mesh = grid(20);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    mesh.vertices[i].z() = i % 2 ? 0.1f : -0.1f;
  CleanOptions options = nothing();
  options.smooth = 5;
  double before = 0, after = 0;
  for (const Eigen::Vector3f& v : mesh.vertices) before += std::abs(static_cast<double>(v.z()));
  for (const Eigen::Vector3f& v : clean(mesh, options).vertices)
    after += std::abs(static_cast<double>(v.z()));
  EXPECT_LT(after, 0.5 * before);
}

TEST(Clean, DecimationKeepsAPlaneAndRemeshingTheLength) {
  CleanOptions options = nothing();
  options.decimate = 0.25;
  const Mesh coarse = clean(grid(20), options);
  EXPECT_NEAR(static_cast<double>(coarse.faces.size()), 200, 20);
  EXPECT_NEAR(area(coarse), 400, 4);
  options = nothing();
  options.target_faces = 100;
  EXPECT_NEAR(static_cast<double>(clean(grid(20), options).faces.size()), 100, 15);
  options = nothing();
  options.edge_length = 0.5;
  const Mesh fine = clean(grid(10), options);
  EXPECT_GT(fine.faces.size(), 600u);  // equilateral triangles of side 0.5: 924
  EXPECT_LT(fine.faces.size(), 1600u);
  EXPECT_NEAR(area(fine), 100, 1);
}

TEST(Clean, RefusesMeshesWithoutFaces) {
  EXPECT_THAT(error_of([] { clean({}); }), testing::HasSubstr("no faces"));
  CleanOptions options;
  options.spurious = 1000;
  EXPECT_THAT(error_of([&] { clean(grid(3), options); }), testing::HasSubstr("spurious"));
}

TEST(Clean, RefusesToRemeshWithoutEndOrArea) {
  CleanOptions options = nothing();
  options.edge_length = 0.5;
  Mesh point = grid(3);
  for (Eigen::Vector3f& v : point.vertices) v.setOnes();
  EXPECT_THAT(error_of([&] { clean(point, options); }), testing::HasSubstr("no area"));
  options.edge_length = 1e-9;
  EXPECT_THAT(error_of([&] { clean(grid(3), options); }),
              testing::HasSubstr("would make more than"));
  Mesh needles = grid(3);
  for (Eigen::Vector3f& v : needles.vertices) v.y() *= 1e-20f;
  EXPECT_THAT(error_of([&] { clean(needles, options); }),
              testing::HasSubstr("would make more than"));
}

}  // namespace
}  // namespace axial::mesh
