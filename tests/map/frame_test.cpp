// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "map/up_direction.h"
#include "support/error_of.h"
#include "worlds/height_field.h"

namespace axial::map {
namespace {

using testing::HasSubstr;

TEST(MapFrame, HasTheAxesOfTheWorldIfZIsUp) {
  const MapFrame frame = frame_with_up({0, 0, 5}, {{500000, 4500000, -20}});
  EXPECT_EQ(frame.axes, Eigen::Matrix3d::Identity());
  EXPECT_EQ(frame.origin, Eigen::Vector3d(500000, 4500000, -20));
}

TEST(MapFrame, IsRightHandedWithUpAsHeight) {
  for (const Eigen::Vector3d& up :
       {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(1, 0, 0),
        Eigen::Vector3d(-1, 0.2, 0.3), Eigen::Vector3d(0.3, 0.5, -2)}) {
    const MapFrame frame = frame_with_up(up, {{1, 2, 3}});
    EXPECT_LT((frame.axes * frame.axes.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(frame.axes.determinant(), 1, 1e-14);
    EXPECT_LT((frame.axes.row(2).transpose() - up.normalized()).norm(), 1e-14);
    // The origin of the world is at the origin of the map. Heights are measured from the origin of
    // the mesh's frame.
    EXPECT_LT(frame.to_map({-1, -2, -3}).head<2>().norm(), 1e-14);
    EXPECT_EQ(frame.to_map({0, 0, 0}).z(), 0);
    // So they are small and exact in a frame far from the origin of the world.
    const MapFrame far = frame_with_up(up, {{500000, 4500000, 30}});
    EXPECT_NEAR(far.to_map({0.1, 0.2, 0.3}).z(),
                up.normalized().dot(Eigen::Vector3d(0.1, 0.2, 0.3)), 1e-15);
    const bool along_x = std::abs(up.normalized().x()) > std::sqrt(0.5);
    EXPECT_GT(frame.axes(0, along_x ? 1 : 0), 0.1);
  }
}

Mesh turned(Mesh mesh, const Eigen::Quaterniond& turn) {
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex = (turn * vertex.cast<double>()).cast<float>();
  return mesh;
}

// A plate from x = -1 to 1 m with a finely meshed strip that begins at 0.8 m and is 0.1 m higher.
// The slope of the surface's plane is the covariance of height and x, divided by the variance of x:
// 0.1 * 0.1 m * 0.9 m / (1/3 m^2) = 0.027. The slope of the vertices' plane would be 0.075.
TEST(MapFrame, UpIsNormalToThePlaneOfTheSurface) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.2, -0.3, 1).normalized();
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
  Mesh mesh;
  const auto add_patch = [&](double x0, double x1, double height, std::uint32_t cells) {
    test::append(mesh, turned(test::height_field({x0, -1}, {x1, 1}, cells,
                                                 [&](double, double) { return height; }),
                              turn));
  };
  add_patch(-1, 0.8, 0, 20), add_patch(0.8, 1, 0.1, 60);
  const std::vector<Eigen::Vector3d> above{5 * normal}, below{-5 * normal};
  const Eigen::Vector3d found = turn.conjugate() * fitted_up(mesh, above);
  // The squares of distances from the plane are summed, not those of heights.
  EXPECT_NEAR(-found.x() / found.z(), 0.027, 0.002);
  EXPECT_NEAR(found.y(), 0, 1e-6);
  EXPECT_LT((fitted_up(mesh, above) + fitted_up(mesh, below)).norm(), 1e-12);
}

// A hilly square of 2 m with faces of 0.1 m, turned by some angle.
Mesh hills() {
  const auto turn =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), Eigen::Vector3d(0.2, -0.3, 1));
  const auto height = [](double x, double y) { return 0.1 * std::sin(5 * x + 3 * y); };
  return turned(test::height_field({0, 0}, {2, 2}, 20, height), turn);
}

void add_face(Mesh& mesh, const Eigen::Vector3f& place, float side) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(place);
  mesh.vertices.push_back(place + Eigen::Vector3f(side, 0, 0));
  mesh.vertices.push_back(place + Eigen::Vector3f(0, side, 0));
  mesh.faces.push_back({first, first + 1, first + 2});
}

// One face 200 m away would tilt the plane by some degrees, or up to the direction to the face.
TEST(FittedPlane, FacesFarAwayDoNotTiltIt) {
  const Mesh mesh = hills();
  const FittedPlane plain = fitted_plane(mesh);
  for (const Eigen::Vector3f& place :
       {Eigen::Vector3f(0, 0, 200), Eigen::Vector3f(200, 0, 30), Eigen::Vector3f(-90, 120, -130)})
    for (const float side : {0.01f, 0.1f, 0.3f}) {
      Mesh with_stray = mesh;
      add_face(with_stray, place, side);
      const FittedPlane found = fitted_plane(with_stray);
      EXPECT_EQ(found.normal, plain.normal);
      EXPECT_EQ(found.point, plain.point);
    }
}

TEST(FittedPlane, LargePartsFarAwayBelongToTheSurface) {
  Mesh mesh = hills();
  // 10 % of the area, at ten times the size of the hills.
  for (int i = 0; i < 10; ++i) add_face(mesh, {20.f + 0.3f * static_cast<float>(i), 0, 5}, 0.3f);
  EXPECT_GT(fitted_plane(mesh).normal.cross(fitted_plane(hills()).normal).norm(), 0.1);
}

TEST(FittedPlane, FacesInThePlaneDoNotChangeIt) {
  Mesh mesh = hills();
  const FittedPlane plain = fitted_plane(mesh);
  // On the plane, far away: the plane of all faces is as good as that without the face, and counts.
  const Eigen::Vector3d along = plain.normal.unitOrthogonal();
  add_face(mesh, (plain.point + 20 * along).cast<float>(), 0.01f);
  const FittedPlane found = fitted_plane(mesh);
  EXPECT_LT(found.normal.cross(plain.normal).norm(), 1e-3);
  EXPECT_NE(found.point, plain.point);
}

TEST(UpDirection, KnowsTheFarSide) {
  EXPECT_FALSE(shows_far_side({0, 0, 5}, {0, 0, 0.5}));
  EXPECT_TRUE(shows_far_side({0, 0, 5}, {0, 0, -0.5}));
  EXPECT_FALSE(shows_far_side({0, 0, 5}, {0.9, 0, -0.1}));  // a wall
  EXPECT_FALSE(shows_far_side({0, 0, 5}, {0, 0, 0}));       // not known
  EXPECT_EQ(up_text({-0.0, 0.25, -1}), "0,0.25,-1");
}

TEST(MapGrid, IsTheSmallestGridOnMultiplesOfThePixel) {
  Mesh mesh;
  mesh.vertices = {{0.15f, 0.25f, 0}, {1.05f, 0.25f, 1}, {0.5f, 2.55f, 0}, {999, 999, 999}};
  mesh.faces = {{0, 1, 2}};  // and a vertex that no face uses
  const MapFrame frame = frame_with_up({0, 0, 1}, {{500000, 4500000, 0}});
  const MapGrid grid = grid_around(mesh, frame, 0.1);
  EXPECT_NEAR(grid.left, 500000.1, 1e-9);
  EXPECT_NEAR(grid.top, 4500002.6, 1e-9);
  EXPECT_EQ(grid.columns, 10);
  EXPECT_EQ(grid.rows, 24);
  EXPECT_THAT(test::error_of([&] { grid_around(mesh, frame, 1e-6); }),
              HasSubstr("ground_sample_distance 1e-06: the map would have 900000 x 2300000"));
}

TEST(Crs, IsAProjectedSystemInMetres) {
  EXPECT_THAT(crs_of_epsg(32631),
              testing::StartsWith("PROJCS[\"WGS 84 / UTM zone 31N\""));  // WKT 1
  EXPECT_THAT(test::error_of([] { crs_of_epsg(4326); }), HasSubstr("epsg 4326: is no projected"));
  EXPECT_THAT(test::error_of([] { crs_of_epsg(2263); }), HasSubstr("epsg 2263: is no projected"));
  EXPECT_THAT(test::error_of([] { crs_of_epsg(99); }), HasSubstr("epsg 99: is no coordinate"));
}

}  // namespace
}  // namespace axial::map
