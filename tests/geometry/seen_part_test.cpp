// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/seen_part.h"

#include <gmock/gmock.h>

#include "base/log.h"
#include "base/parallel.h"

namespace axial::geometry {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A square of `cells` x `cells` cells around (x, 0, 2), whose front is turned to smaller z.
void add_square(Mesh& mesh, std::uint32_t cells, float x, float half) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const float step = 2 * half / static_cast<float>(cells);
  for (std::uint32_t j = 0; j <= cells; ++j)
    for (std::uint32_t i = 0; i <= cells; ++i)
      mesh.vertices.emplace_back(x - half + step * static_cast<float>(i),
                                 step * static_cast<float>(j) - half, 2.f);
  for (std::uint32_t j = 0; j < cells; ++j)
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = first + j * (cells + 1) + i;
      mesh.faces.push_back({a, a + cells + 2, a + 1});
      mesh.faces.push_back({a, a + cells + 1, a + cells + 2});
    }
}

void flip(Mesh& mesh) {
  for (auto& face : mesh.faces) std::swap(face[1], face[2]);
}

// They look along z from z = 0, and see 0.7 m to each side at z = 2 m.
std::vector<PosedCamera> three_cameras() {
  std::vector<PosedCamera> cameras(3);
  for (std::size_t i = 0; i < 3; ++i) {
    cameras[i].camera.width = cameras[i].camera.height = 200;
    cameras[i].camera.lens = {200, 200, 99.5, 99.5};
    cameras[i].camera.port = refractive::FlatPort<double>{{0, 0, 1}, 0.03, 0.01, 1, 1.5, 1.34};
    cameras[i].pose.centre = {0.1 * static_cast<double>(i), 0, 0};
  }
  return cameras;
}

TEST(SeenPart, KnowsTheSideThatTheCamerasSee) {
  Mesh mesh;
  add_square(mesh, 20, 0, 0.5f);
  const SeenPart part = find_seen_part(mesh, three_cameras());
  EXPECT_EQ(part.front, 800u);
  EXPECT_EQ(part.back, 0u);
  EXPECT_FALSE(part.is_inside_out());
  EXPECT_LT((part.facing - Eigen::Vector3d(0, 0, -1)).norm(), 1e-9);
  flip(mesh);
  const SeenPart turned = find_seen_part(mesh, three_cameras());
  EXPECT_EQ(turned.back, 800u);
  EXPECT_TRUE(turned.is_inside_out());
  EXPECT_LT((turned.facing - part.facing).norm(), 1e-9);
}

TEST(SeenPart, ASampleSuffices) {
  Mesh mesh;
  add_square(mesh, 20, 0, 0.5f);
  flip(mesh);
  const SeenPart part = find_seen_part(mesh, three_cameras(), {.faces = 50, .cameras = 1});
  EXPECT_EQ(part.back, 50u);
  EXPECT_TRUE(part.is_inside_out());
}

TEST(SeenPart, UnseenFacesFarFromTheSeenOnesAreStrays) {
  Mesh mesh;
  add_square(mesh, 10, 0, 0.5f);
  add_square(mesh, 1, -0.9f, 0.05f);  // not seen, and no further than half of the seen part
  add_square(mesh, 1, 500.f, 0.05f);  // the strays
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
  Mesh mesh;
  add_square(mesh, 2, 100, 0.5f);
  const SeenPart part = find_seen_part(mesh, three_cameras());
  EXPECT_EQ(part.front + part.back, 0u);
  EXPECT_FALSE(part.is_inside_out());
  EXPECT_TRUE(part.facing.isZero(0));
  EXPECT_THAT(part.strays, IsEmpty());
}

TEST(SeenPart, TheWarningNamesTheMeshAndTheRemedy) {
  const LogCapture log;
  warn_if_inside_out({.front = 10, .back = 20}, "a.ply");
  EXPECT_EQ(log.text(), "");
  warn_if_inside_out({.front = 1, .back = 99}, "a.ply");
  EXPECT_THAT(log.text(), HasSubstr("a.ply: the mesh is inside out: the cameras see 99 % of its "
                                    "faces from behind; flip the faces in an editor"));
}

TEST(EraseAt, KeepsTheOthers) {
  std::vector<int> values{0, 1, 2, 3, 4};
  erase_at(std::vector<std::uint32_t>{0, 3}, values);
  EXPECT_THAT(values, ElementsAre(1, 2, 4));
}

}  // namespace
}  // namespace axial::geometry
