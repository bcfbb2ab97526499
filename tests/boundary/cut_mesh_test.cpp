// SPDX-License-Identifier: GPL-3.0-or-later
#include "boundary/cut_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "drawn.h"
#include "support/error_of.h"
#include "support/rings.h"

namespace axial::boundary {
namespace {

using geometry::Ring;
using geometry::signed_area;
using test::is_inside;
using test::star;
using testing::HasSubstr;

constexpr int kSide = 20;  // squares along each side of a grid

// Heights of a rough, closed-form ground.
double height_at(double x, double y) {
  return 0.3 * std::sin(7 * x) + 0.2 * std::cos(5 * y) + 0.1 * x * y;
}

// A grid of triangles over [0, 1] x [0, 1]. `noise`: of the places of inner vertices, in squares.
Mesh ground(double noise, bool level = false) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-noise, noise);
  Mesh mesh;
  for (int j = 0; j <= kSide; ++j)
    for (int i = 0; i <= kSide; ++i) {
      const bool inner = i > 0 && j > 0 && i < kSide && j < kSide;
      const double x = (i + (inner ? shift(random) : 0)) / kSide;
      const double y = (j + (inner ? shift(random) : 0)) / kSide;
      mesh.vertices.emplace_back(Eigen::Vector3d(x, y, level ? 0 : height_at(x, y)).cast<float>());
    }
  const auto at = [](int i, int j) { return static_cast<std::uint32_t>(j * (kSide + 1) + i); };
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

// A closed surface: a sphere of radius 0.4 about (0.5, 0.5, 0), with upright edges.
Mesh ball() {
  constexpr int kAround = 24, kAlong = 12;
  Mesh mesh;
  const auto add = [&](double polar, double angle) {
    mesh.vertices.emplace_back(Eigen::Vector3d(0.5 + 0.4 * std::sin(polar) * std::cos(angle),
                                               0.5 + 0.4 * std::sin(polar) * std::sin(angle),
                                               0.4 * std::cos(polar))
                                   .cast<float>());
  };
  for (int j = 1; j < kAlong; ++j)
    for (int i = 0; i < kAround; ++i)
      add(std::numbers::pi * j / kAlong, 2 * std::numbers::pi * i / kAround);
  add(0, 0), add(std::numbers::pi, 0);
  const auto at = [](int i, int j) {
    return static_cast<std::uint32_t>((j - 1) * kAround + i % kAround);
  };
  const auto top = static_cast<std::uint32_t>(mesh.vertices.size() - 2);
  for (int i = 0; i < kAround; ++i) {
    mesh.faces.push_back({top, at(i, 1), at(i + 1, 1)});
    mesh.faces.push_back({top + 1, at(i + 1, kAlong - 1), at(i, kAlong - 1)});
    for (int j = 1; j + 1 < kAlong; ++j) {
      mesh.faces.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return mesh;
}

double distance_to(const Ring& ring, const Eigen::Vector2d& place) {
  double least = 1e9;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
    const double along = std::clamp((place - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    least = std::min(least, (a + along * (b - a) - place).norm());
  }
  return least;
}

Eigen::Vector3d area_vector(const Mesh& mesh, std::size_t face) {
  const auto at = [&](std::size_t k) {
    return mesh.vertices[mesh.faces[face][k]].cast<double>().eval();
  };
  return (at(1) - at(0)).cross(at(2) - at(0)) / 2;
}

struct Areas {
  double surface = 0, plan = 0;
};
Areas areas_of(const Mesh& mesh) {
  Areas areas;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    areas.surface += area_vector(mesh, f).norm();
    areas.plan += area_vector(mesh, f).z();
  }
  return areas;
}

Boundary boundary_of(std::vector<Boundary::Polygon> polygons) {
  return Boundary(std::move(polygons), {}, {}, "plot");
}

// Vertices are float, so that a place moves by 6e-8.
constexpr double kAreaError = 1e-6;

void expect_split_at(Mesh mesh, const Ring& ring) {
  const Mesh before = mesh;
  const Boundary boundary = boundary_of({{ring}});
  mark_outside(mesh, boundary);
  EXPECT_NEAR(areas_of(mesh).surface, areas_of(before).surface, kAreaError);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(0.02, 0.98);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (int sample = 0; sample < 4; ++sample) {
      Eigen::Vector3d weights = axial::test::drawn<3>(any, random);
      weights /= weights.sum();
      Eigen::Vector3d place = Eigen::Vector3d::Zero();
      for (std::size_t k = 0; k < 3; ++k)
        place +=
            weights[static_cast<Eigen::Index>(k)] * mesh.vertices[mesh.faces[f][k]].cast<double>();
      if (distance_to(ring, place.head<2>()) < 2e-6) continue;
      EXPECT_EQ(mesh.unseen[f] == kOutside, !is_inside(ring, place.head<2>())) << "face " << f;
    }
}

TEST(CutMesh, EachFaceIsOnOneSide) {
  expect_split_at(ground(0.3), star({0.5, 0.5}, 0.2, 0.4, 7));
  expect_split_at(ground(0.3), star({0.8, 0.9}, 0.3, 0.6, 5));    // beyond the border of the mesh
  expect_split_at(ground(0.3), star({0.5, 0.5}, 0.01, 0.02, 9));  // smaller than a face
  expect_split_at(ground(0.3), star({0.5, 0.5}, 0.39, 0.4, 300));
  expect_split_at(ball(), star({0.45, 0.55}, 0.15, 0.35, 6));
}

TEST(CutMesh, ALevelPlaneHasTheAreaOfThePolygons) {
  const Ring outer = star({0.5, 0.5}, 0.3, 0.45, 7), hole = star({0.45, 0.5}, 0.1, 0.15, 4);
  const Ring other{{0.9, 0.9}, {0.99, 0.91}, {0.93, 0.98}};
  Mesh mesh = ground(0.3, true);
  mark_outside(mesh, boundary_of({{outer, hole}, {other}}));
  remove_outside(mesh);
  EXPECT_TRUE(mesh.unseen.empty());
  EXPECT_NEAR(
      areas_of(mesh).plan,
      std::abs(signed_area(outer)) - std::abs(signed_area(hole)) + std::abs(signed_area(other)),
      kAreaError);
}

// Corners at vertices, sides along edges, through vertices and along diagonals.
TEST(CutMesh, APolygonOnTheLinesOfAGridAddsNoVertices) {
  Mesh mesh = ground(0, true);
  const std::size_t vertices = mesh.vertices.size(), faces = mesh.faces.size();
  const Ring ring{{0.1, 0.1}, {0.6, 0.1}, {0.8, 0.3}, {0.8, 0.8}, {0.1, 0.8}};
  mark_outside(mesh, boundary_of({{ring}}));
  EXPECT_EQ(mesh.vertices.size(), vertices);
  EXPECT_EQ(mesh.faces.size(), faces);
  remove_outside(mesh);
  EXPECT_NEAR(areas_of(mesh).plan, std::abs(signed_area(ring)), kAreaError);
}

TEST(CutMesh, OverlappingPolygonsAreJoined) {
  const Ring a{{0.1, 0.1}, {0.6, 0.1}, {0.6, 0.6}, {0.1, 0.6}};
  const Ring b{{0.33, 0.33}, {0.83, 0.33}, {0.83, 0.83}, {0.33, 0.83}};
  Mesh mesh = ground(0.3, true);
  mark_outside(mesh, boundary_of({{a}, {b}}));
  remove_outside(mesh);
  EXPECT_NEAR(areas_of(mesh).plan, 2 * 0.25 - 0.27 * 0.27, kAreaError);
}

// Each edge of a closed mesh has one face in each direction, before and after.
TEST(CutMesh, AClosedMeshStaysClosed) {
  for (const Ring& ring : {star({0.5, 0.5}, 0.2, 0.3, 7), star({0.3, 0.6}, 0.1, 0.9, 3),
                           Ring{{0.5, 0.5}, {0.9, 0.5}, {0.9, 0.9}, {0.5, 0.9}}}) {
    Mesh mesh = ball();
    mark_outside(mesh, boundary_of({{ring}}));
    EXPECT_FALSE(outside_faces(mesh).empty());
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& face : mesh.faces)
      for (std::size_t k = 0; k < 3; ++k) ++edges[{face[k], face[(k + 1) % 3]}];
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1);
      EXPECT_EQ(edges.contains({edge.second, edge.first}), true);
    }
  }
}

TEST(CutMesh, UprightFacesAreCut) {
  Mesh mesh;  // a wall along x
  mesh.vertices = {{0, 0.5F, 0}, {1, 0.5F, 0}, {1, 0.5F, 1}, {0, 0.5F, 1}};
  mesh.faces = {{0, 1, 2}, {0, 2, 3}};
  mark_outside(mesh, boundary_of({{{{0.25, 0}, {0.75, 0}, {0.75, 1}, {0.25, 1}}}}));
  remove_outside(mesh);
  EXPECT_NEAR(areas_of(mesh).surface, 0.5, kAreaError);
}

TEST(CutMesh, PiecesHaveTheValuesOfTheirFace) {
  TexturedMesh mesh;
  mesh.mesh = ground(0.3);
  mesh.textures.emplace_back(8, 8);
  const auto place_of = [](const Eigen::Vector3f& x) {  // linear in the place
    return Eigen::Vector2f(100 * x.x() + 20 * x.y() + 3, 50 * x.y() - 10 * x.x());
  };
  for (const Eigen::Vector3f& x : mesh.mesh.vertices)
    mesh.mesh.colors.push_back(
        {static_cast<std::uint8_t>(200 * x.x()), static_cast<std::uint8_t>(200 * x.y()), 7});
  for (std::size_t f = 0; f < mesh.mesh.faces.size(); ++f) {
    auto& uv = mesh.uv.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) uv[k] = place_of(mesh.mesh.vertices[mesh.mesh.faces[f][k]]);
    mesh.texture_of.push_back(static_cast<std::uint32_t>(f));
    mesh.mesh.unseen.push_back(f % 3 == 0);
  }
  mark_outside(mesh, boundary_of({{star({0.5, 0.5}, 0.2, 0.4, 5)}}));
  remove_outside(mesh);
  ASSERT_EQ(mesh.uv.size(), mesh.mesh.faces.size());
  ASSERT_EQ(mesh.mesh.unseen.size(), mesh.mesh.faces.size());
  ASSERT_EQ(mesh.mesh.colors.size(), mesh.mesh.vertices.size());
  for (std::size_t f = 0; f < mesh.uv.size(); ++f) {
    EXPECT_EQ(mesh.mesh.unseen[f], mesh.texture_of[f] % 3 == 0);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LT((mesh.uv[f][k] - place_of(mesh.mesh.vertices[mesh.mesh.faces[f][k]])).norm(), 1e-4);
  }
  for (std::size_t v = 0; v < mesh.mesh.vertices.size(); ++v)  // rounding down, twice
    EXPECT_NEAR(mesh.mesh.colors[v][0], 200 * mesh.mesh.vertices[v].x(), 2);
}

TEST(CutMesh, ABoundaryBesideTheSurfaceIsAnErrorThatStatesBothExtents) {
  Mesh mesh = ground(0);
  const Boundary far = boundary_of({{{{5, 6}, {7, 6}, {7, 8}}}});
  EXPECT_THAT(test::error_of([&] { mark_outside(mesh, far); }),
              HasSubstr("plot: lies outside of the surface: x from 5.00 to 7.00 and y from 6.00 to "
                        "8.00, but the surface has x from 0.00 to 1.00 and y from 0.00 to 1.00"));
}

TEST(CutMesh, TooManySidesAboveAFaceAreAnErrorOfTheBoundary) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.faces = {{0, 1, 2}};
  const Boundary circle = boundary_of({{star({0.3, 0.3}, 0.1, 0.1, 6000)}});
  EXPECT_THAT(test::error_of([&] { mark_outside(mesh, circle); }),
              HasSubstr("plot: has 12000 sides above one face of the mesh"));
}

}  // namespace
}  // namespace axial::boundary
