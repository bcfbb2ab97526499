// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/local_frame.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace axial {
namespace {

const Eigen::Vector3d kUtm(534000, 3378500, 30);

// `count` random places. Each coordinate differs from that of `middle` by at most `spread`, in
// steps of 1e-6 `spread`.
std::vector<Eigen::Vector3d> places(std::size_t count, const Eigen::Vector3d& middle,
                                    double spread) {
  std::vector<Eigen::Vector3d> result(count);
  const auto scalar = [&] {
    return spread * static_cast<double>(*rc::gen::inRange(-1'000'000, 1'000'001)) * 1e-6;
  };
  for (Eigen::Vector3d& x : result) x = middle + Eigen::Vector3d(scalar(), scalar(), scalar());
  return result;
}

std::size_t some() {
  return static_cast<std::size_t>(*rc::gen::inRange(1, 20));
}

RC_GTEST_PROP(LocalFrame, IsTheWorldNearItsOrigin, ()) {
  RC_ASSERT(frame_of(places(some(), {0, 0, 0}, 570), places(some(), {0, 0, 0}, 570)).is_world());
  RC_ASSERT(frame_of(places(some(), {0, 0, 0}, 570), {}).is_world());
  RC_ASSERT(frame_of({}, places(some(), kUtm, 570)).is_world());
}

RC_GTEST_PROP(LocalFrame, IsNearAFarScene, ()) {
  const auto centres = places(some(), kUtm, 20), points = places(some(), kUtm, 20);
  const LocalFrame frame = frame_of(centres, points);
  for (const double x : frame.origin) RC_ASSERT(std::fmod(x, 10) == 0);
  for (const Eigen::Vector3d& centre : centres) {
    RC_ASSERT(frame.to_local(centre).cwiseAbs().maxCoeff() <= 45);
    // Local coordinates are below 64, where doubles are 64 epsilon apart at most. World coordinates
    // that are larger are restored exactly. Smaller ones, such as heights, may be rounded.
    const double step = 64 * std::numeric_limits<double>::epsilon();
    const Eigen::Vector3d back = frame.to_world(frame.to_local(centre));
    RC_ASSERT((back - centre).cwiseAbs().maxCoeff() <= step);
    RC_ASSERT(back.head<2>() == centre.head<2>());
  }
}

RC_GTEST_PROP(LocalFrame, MovesWithTheScene, ()) {
  // A shift by multiples of ten changes only the origin.
  const auto tens = [] { return 10.0 * *rc::gen::inRange(200, 600000); };
  const Eigen::Vector3d shift(tens(), tens(), tens());
  auto centres = places(some(), {3000, 0, 0}, 20), moved = centres;
  for (Eigen::Vector3d& x : moved) x += shift;
  RC_ASSERT(frame_of(moved, {}).origin == frame_of(centres, {}).origin + shift);
  std::shuffle(moved.begin(), moved.end(), std::minstd_rand(1));
  RC_ASSERT(frame_of(moved, {}).origin == frame_of(centres, {}).origin + shift);
}

TEST(LocalFrame, FewStrayCamerasDoNotMoveANearScene) {
  std::vector<Eigen::Vector3d> centres(9, Eigen::Vector3d(3, 4, -4));
  centres.emplace_back(1e7, -1e7, 1e7);
  EXPECT_TRUE(frame_of(centres, {}).is_world());
}

TEST(LocalFrame, OfOnePlace) {
  EXPECT_TRUE(frame_near({999, 0, 0}).is_world());
  EXPECT_EQ(frame_near({1234, 0, 0}).origin, Eigen::Vector3d(1230, 0, 0));
  EXPECT_EQ(frame_near(-kUtm).origin, Eigen::Vector3d(-534000, -3378500, -30));
  EXPECT_FALSE(std::signbit(frame_near({5000, -1, 0}).origin.y()));
}

RC_GTEST_PROP(LocalFrame, TakesAWholeScene, ()) {
  Scene scene;
  for (const Eigen::Vector3d& centre : places(some(), kUtm, 20)) {
    scene.images.emplace_back().pose.centre = centre;
    scene.points.emplace_back().position = centre.cast<float>();
  }
  scene.images.emplace_back().calibrated = false;  // its pose must be ignored
  scene.region = OrientedBox{Eigen::Matrix3d::Identity(), kUtm, {1, 2, 3}};
  const LocalFrame frame = frame_of(scene);
  Scene local = scene;
  enter(frame, local);
  RC_ASSERT(!frame.is_world());
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    const Eigen::Vector3d point = scene.points[i].position.cast<double>();
    RC_ASSERT(local.images[i].pose.centre == scene.images[i].pose.centre - frame.origin);
    RC_ASSERT(local.points[i].position == (point - frame.origin).cast<float>());
  }
  RC_ASSERT(local.region->centre == kUtm - frame.origin);
  RC_ASSERT(local.region->half_extent == scene.region->half_extent);
}

}  // namespace
}  // namespace axial
