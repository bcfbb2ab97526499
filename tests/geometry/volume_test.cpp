// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/volume.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "evaluate/shapes.h"

namespace axial::geometry {
namespace {

using namespace evaluate;  // shapes

constexpr double kPi = std::numbers::pi;

// The volume of a ball is known up to the facets of its mesh: their volume is smaller by the
// relative error 6e-5 of the radius, three times.
TEST(Volume, OfABall) {
  Mesh ball = sphere(0.5, 300);
  for (Eigen::Vector3f& x : ball.vertices) x += Eigen::Vector3f(30, -20, 10);
  const double expected = 4 * kPi / 3 * 0.125;
  EXPECT_NEAR(enclosed_volume(ball) / expected, 1, 3e-4);
  const Plane below{{0, 0, 1}, 9};
  EXPECT_NEAR(volume_above(ball, below) / expected, 1, 3e-4);
  // A cap of the height h has the volume pi h^2 (3 r - h) / 3. The plane is tilted.
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 2, 3).normalized();
  const Plane cut{normal, normal.dot(Eigen::Vector3d(30, -20, 10)) + 0.3};
  EXPECT_NEAR(volume_above(ball, cut) / (kPi * 0.04 * 1.3 / 3), 1, 1e-3);
  for (auto& face : ball.faces) std::swap(face[0], face[1]);
  EXPECT_NEAR(enclosed_volume(ball) / expected, -1, 3e-4);
}

// A heap on a flat ground: the integral of its height.
TEST(Volume, OfAHeapOnItsGround) {
  const auto heap = [](double x, double y) { return 0.3 * std::exp(-20 * (x * x + y * y)); };
  Mesh mesh = height_field(200, 4, heap);
  const double expected = 0.3 * kPi / 20;
  EXPECT_NEAR(volume_above(mesh, Plane{}) / expected, 1, 1e-3);
  // The fitted plane is higher than the ground by a part of its threshold, because the foot of the
  // heap lies within the threshold, too.
  const double threshold = 0.001;
  const Plane plane = ground_plane(mesh, {0, 0, 1}, {2, threshold});
  EXPECT_GT(plane.normal.z(), 1 - 1e-6);
  EXPECT_LT(std::abs(plane.offset), threshold);
  EXPECT_NEAR(volume_above(mesh, plane) / expected, 1, 0.02);
  // From the other side the heap is a pit, and its faces look down.
  const Plane turned = ground_plane(mesh, {0, 0, -1}, {2, threshold});
  EXPECT_LT(turned.normal.z(), -1 + 1e-6);
}

TEST(Volume, NoGroundAcrossTheUpAxis) {
  EXPECT_THROW(ground_plane(flat_square(2, 0), {0, 0, 1}, {0, 0}), Error);
  EXPECT_NO_THROW(ground_plane(flat_square(2, 0), {0, 0, 1}, {2, 0}));
}

}  // namespace
}  // namespace axial::geometry
