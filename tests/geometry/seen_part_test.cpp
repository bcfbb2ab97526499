// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/seen_part.h"

#include <gmock/gmock.h>

#include "base/parallel.h"
#include "support/captured_events.h"
#include "worlds/height_field.h"
#include "worlds/ports.h"

namespace axial::geometry {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A square of `cells` x `cells` cells around (x, 0, 2), whose front is turned to smaller z.
Mesh square(std::uint32_t cells, double x, double half) {
  return test::flipped(test::level_square({x, 0, 2}, 2 * half, cells));
}

// They look along z from z = 0, and see 0.7 m to each side at z = 2 m.
std::vector<PosedCamera> three_cameras() {
  std::vector<PosedCamera> cameras;
  for (const double x : {0.0, 0.1, 0.2})
    cameras.push_back(test::camera_at({x, 0, 0}, 200, 200, 200, true));
  return cameras;
}

TEST(SeenPart, KnowsTheSideThatTheCamerasSee) {
  Mesh mesh = square(20, 0, 0.5);
  const SeenPart part = find_seen_part(mesh, three_cameras());
  EXPECT_EQ(part.front, 800u);
  EXPECT_EQ(part.back, 0u);
  EXPECT_FALSE(part.is_inside_out());
  EXPECT_LT((part.facing - Eigen::Vector3d(0, 0, -1)).norm(), 1e-9);
  mesh = test::flipped(mesh);
  const SeenPart turned = find_seen_part(mesh, three_cameras());
  EXPECT_EQ(turned.back, 800u);
  EXPECT_TRUE(turned.is_inside_out());
  EXPECT_LT((turned.facing - part.facing).norm(), 1e-9);
}

TEST(SeenPart, ASampleSuffices) {
  Mesh mesh = square(20, 0, 0.5);
  mesh = test::flipped(mesh);
  const SeenPart part = find_seen_part(mesh, three_cameras(), {.faces = 50, .cameras = 1});
  EXPECT_EQ(part.back, 50u);
  EXPECT_TRUE(part.is_inside_out());
}

TEST(SeenPart, UnseenFacesFarFromTheSeenOnesAreStrays) {
  Mesh mesh = square(10, 0, 0.5);
  test::append(mesh, square(1, -0.9, 0.05));  // not seen, and no further than half of the seen part
  test::append(mesh, square(1, 500, 0.05));   // the strays
  for (const unsigned threads : {1u, 2u}) {
    const ThreadLimit limit(threads);
    EXPECT_THAT(find_seen_part(mesh, three_cameras()).strays, ElementsAre(202, 203));
  }
  EXPECT_THAT(find_seen_part(mesh, three_cameras(), {.strays = false}).strays, IsEmpty());
  // A camera sees the face far away.
  std::vector<PosedCamera> cameras = three_cameras();
  cameras.push_back(cameras[0]);
  cameras.back().pose.centre = {500, 0, 0};
  EXPECT_THAT(find_seen_part(mesh, cameras).strays, IsEmpty());
}

TEST(SeenPart, WithoutSightsThereIsNothing) {
  Mesh mesh = square(2, 100, 0.5);
  const SeenPart part = find_seen_part(mesh, three_cameras());
  EXPECT_EQ(part.front + part.back, 0u);
  EXPECT_FALSE(part.is_inside_out());
  EXPECT_TRUE(part.facing.isZero(0));
  EXPECT_THAT(part.strays, IsEmpty());
}

TEST(SeenPart, TheWarningNamesTheMeshAndTheRemedy) {
  const test::CapturedEvents events;
  warn_if_inside_out({.front = 10, .back = 20}, "a.ply", events.context);
  EXPECT_EQ(events.lines, "");
  warn_if_inside_out({.front = 1, .back = 99}, "a.ply", events.context);
  EXPECT_THAT(events.lines, HasSubstr("a.ply: the mesh is inside out: the cameras see 99 % of its "
                                      "faces from behind; flip the faces in an editor"));
}

TEST(EraseAt, KeepsTheOthers) {
  std::vector<int> values{0, 1, 2, 3, 4};
  erase_at(std::vector<std::uint32_t>{0, 3}, values);
  EXPECT_THAT(values, ElementsAre(1, 2, 4));
}

}  // namespace
}  // namespace axial::geometry
