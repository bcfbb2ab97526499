// SPDX-License-Identifier: GPL-3.0-or-later
// Two cameras without a port look down on a level ground with a block on it.
#include "color/observations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/context.h"

namespace axial::color {
namespace {

constexpr double kHigh = 2;                // of the cameras [m]
constexpr float kBlock = 0.5f;             // height of the block [m]
constexpr float kLow = 0.2f, kEnd = 0.7f;  // of the block, in x and y [m]

void add_square(Mesh& mesh, const std::array<Eigen::Vector3f, 4>& corners) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  mesh.faces.push_back({first, first + 1, first + 2});
  mesh.faces.push_back({first, first + 2, first + 3});
}

// The ground z = 0 and the top and the four sides of a block, faces outwards.
Mesh ground_with_block() {
  Mesh mesh;
  add_square(mesh, {{{-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}}});
  const auto at = [](float x, float y, float z) { return Eigen::Vector3f(x, y, z); };
  const float a = kLow, b = kEnd, h = kBlock;
  add_square(mesh, {{at(a, a, h), at(b, a, h), at(b, b, h), at(a, b, h)}});
  add_square(mesh, {{at(a, a, 0), at(b, a, 0), at(b, a, h), at(a, a, h)}});
  add_square(mesh, {{at(b, b, 0), at(a, b, 0), at(a, b, h), at(b, b, h)}});
  add_square(mesh, {{at(a, b, 0), at(a, a, 0), at(a, a, h), at(a, b, h)}});
  add_square(mesh, {{at(b, a, 0), at(b, b, 0), at(b, b, h), at(b, a, h)}});
  return mesh;
}

// Looks down from (x, 0, kHigh).
geometry::PosedCamera camera_at(double x) {
  geometry::PosedCamera posed;
  posed.camera.width = 320;
  posed.camera.height = 240;
  posed.camera.lens.fx = posed.camera.lens.fy = 200;
  posed.camera.lens.cx = 159.5;
  posed.camera.lens.cy = 119.5;
  posed.pose.rotation = Eigen::Vector3d(1, -1, -1).asDiagonal();
  posed.pose.centre = {x, 0, kHigh};
  return posed;
}

Observations observe(const SeenSurface& surface) {
  const std::array<geometry::PosedCamera, 2> cameras{camera_at(-0.3), camera_at(0.3)};
  ObserveOptions options;
  options.points = 3000;
  return surface.observe(
      cameras, [](std::size_t) { return cv::Mat3f(240, 320, cv::Vec3f(0.2f, 0.3f, 0.4f)); },
      options, {});
}

TEST(SeenSurface, TellsWayNormalDirectionAndHeight) {
  const Mesh mesh = ground_with_block();
  const Observations seen = observe(SeenSurface(mesh, Eigen::Vector3d::UnitZ()));
  ASSERT_GT(seen.points(), 500U);
  int on_block = 0;
  for (const Observation& one : seen.all) {
    const Sight& sight = one.sight;
    EXPECT_NEAR(sight.direction.norm(), 1, 1e-5);
    EXPECT_NEAR(kHigh + sight.way * sight.direction.z(), sight.height, 1e-4);
    EXPECT_NEAR(std::min(std::abs(sight.height), std::abs(sight.height - kBlock)), 0, 1e-4);
    EXPECT_NEAR((one.light - Eigen::Array3f(0.2f, 0.3f, 0.4f)).abs().maxCoeff(), 0, 1e-5);
    EXPECT_LT(one.spread.maxCoeff(), 1e-5f);
    on_block += sight.height > 0.1f ? 1 : 0;
  }
  EXPECT_GT(on_block, 20);
}

// Pieces at the edges of the block are uneven: none is seen.
TEST(SeenSurface, LeavesOutUnevenPieces) {
  const Mesh mesh = ground_with_block();
  const Observations seen = observe(SeenSurface(mesh, Eigen::Vector3d::UnitZ()));
  for (const Observation& one : seen.all) {
    const double x = (one.view == 0 ? -0.3 : 0.3) + one.sight.way * one.sight.direction.x();
    const double y = one.sight.way * one.sight.direction.y();
    const double from_edge = std::max({kLow - x, x - kEnd, kLow - y, y - kEnd});
    EXPECT_GT(std::abs(from_edge), 0.01) << x << " " << y;
  }
}

// Lamps 0.4 m beside the camera cast the shadow of the block on the ground beside it.
TEST(SeenSurface, MarksPointsThatLampsMayNotReach) {
  const Mesh mesh = ground_with_block();
  const Observations seen = observe(SeenSurface(mesh, Eigen::Vector3d::UnitZ()));
  int closed = 0;
  for (const Observation& one : seen.all) {
    const double x = (one.view == 0 ? -0.3 : 0.3) + one.sight.way * one.sight.direction.x();
    const double y = one.sight.way * one.sight.direction.y();
    // The shadow of a lamp is at most 0.4 m + the block's offset wide, times 0.5 m / 1.5 m.
    const double beside = std::max({kLow - x, x - kEnd, kLow - y, y - kEnd});
    EXPECT_TRUE(one.open || beside <= 0.6) << x << " " << y;
    closed += one.open ? 0 : 1;
  }
  EXPECT_GT(closed, 10);
  const Observations open = without_shadows(seen);
  EXPECT_EQ(open.points(), seen.points());
  EXPECT_EQ(open.all.size() + static_cast<std::size_t>(closed), seen.all.size());
}

TEST(SeenSurface, SightsOfPixelsHaveTheRaysDirectionEverywhere) {
  Mesh small;
  add_square(small, {{{-0.2f, -0.2f, 0}, {0.2f, -0.2f, 0}, {0.2f, 0.2f, 0}, {-0.2f, 0.2f, 0}}});
  const SightImage sights = SeenSurface(small).sights(camera_at(0));
  EXPECT_EQ(sights.at(0, 0).way, 0);
  EXPECT_NEAR(sights.at(160, 120).way, kHigh, 1e-4);
  for (const Sight& sight : {sights.at(0, 0), sights.at(319, 239), sights.at(160, 120)}) {
    EXPECT_NEAR(sight.direction.norm(), 1, 1e-5);
    // place is in units of half the width: 160 px, and the focal length is 200 px.
    EXPECT_NEAR(-sight.direction.x() / sight.direction.z(), sight.place.x() * 160 / 200, 1e-4);
  }
}

}  // namespace
}  // namespace axial::color
