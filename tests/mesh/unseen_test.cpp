// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/unseen.h"

#include <gmock/gmock.h>

#include <numbers>
#include <random>

#include "base/parallel.h"
#include "mesh/cloud_source.h"
#include "support/error_of.h"
#include "topology.h"
#include "worlds/height_field.h"
#include "worlds/ports.h"

namespace axial::mesh {
namespace {

using test::append;
using test::error_of;

// A grid of size x size squares of side 0.01 around (x, 0, z), halved into triangles. The front is
// turned upwards, to -z, where the cameras are.
Mesh plate(std::uint32_t size, float x, float z) {
  return test::flipped(test::level_square({x, 0, z}, 0.01 * size, size));
}

// Cameras at z = 0 that look along z, in air or behind a flat port.
std::vector<geometry::PosedCamera> cameras_at(const std::vector<double>& places, bool wet) {
  std::vector<geometry::PosedCamera> cameras;
  for (const double x : places) cameras.push_back(test::camera_at({x, 0, 0}, 300, 300, 150, wet));
  return cameras;
}

UnseenOptions holes(double small) {
  UnseenOptions options;
  options.small_holes = small;
  return options;
}

std::size_t count(const std::vector<std::uint8_t>& marks) {
  return static_cast<std::size_t>(std::ranges::count(marks, std::uint8_t{1}));
}

class Unseen : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Media, Unseen, testing::Bool());

// A plate of 0.2 at half of the distance hides the middle of the plate below from every camera near
// the axis: a square of about 0.4, less what the cameras' own distances uncover.
TEST_P(Unseen, SurfaceBehindAnotherIsFoundAndRemoved) {
  Mesh mesh = plate(80, 0, 1);
  const std::size_t below = mesh.faces.size();
  append(mesh, plate(20, 0, 0.5f));
  const auto cameras = cameras_at({-0.02, 0, 0.02}, GetParam());
  const std::vector<std::uint8_t> unseen = unseen_faces(mesh, cameras, holes(0));
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    for (const std::uint32_t v : mesh.faces[f]) middle += mesh.vertices[v] / 3;
    if (f >= below) {
      EXPECT_EQ(unseen[f], 0) << "nothing is above the upper plate";
      continue;
    }
    const float aside = std::max(std::abs(middle.x()), std::abs(middle.y()));
    EXPECT_TRUE(unseen[f] == 1 || aside > 0.14f) << middle.transpose();
    EXPECT_TRUE(unseen[f] == 0 || aside < 0.26f) << middle.transpose();
  }
  UnseenReport report;
  const Mesh rest = without_unseen(mesh, unseen, 0, &report);
  EXPECT_GE(report.faces, count(unseen));
  EXPECT_LE(report.faces, count(unseen) + count(unseen) / 20) << "few faces at the border follow";
  EXPECT_EQ(rest.faces.size(), mesh.faces.size() - report.faces);
  const test::MeshFacts facts = test::facts_of(rest);
  EXPECT_EQ(facts.bad_edges + facts.bad_vertices + facts.unused_vertices, 0u);
}

// One camera sees below the roof; two cameras are needed.
TEST_P(Unseen, OneCameraIsNotEnough) {
  Mesh mesh = plate(30, 0, 1);
  append(mesh, plate(40, 0, 0.5f));
  const std::size_t floor = 30 * 30 * 2;
  const auto seen_by = [&](const std::vector<double>& places) {
    const auto unseen = unseen_faces(mesh, cameras_at(places, GetParam()), holes(0));
    return floor - count({unseen.begin(), unseen.begin() + floor});
  };
  EXPECT_EQ(seen_by({0, 0.01}), 0u);
  EXPECT_EQ(seen_by({0, 0.01, 0.65}), 0u);
  EXPECT_GT(seen_by({0, 0.01, 0.65, 0.66}), floor / 4);
}

TEST(Unseen, BacksAreUnseen) {
  Mesh mesh = plate(20, 0, 1);
  for (auto& face : mesh.faces) std::swap(face[1], face[2]);
  const auto cameras = cameras_at({0, 0.1}, false);
  EXPECT_EQ(count(unseen_faces(mesh, cameras, holes(0))), mesh.faces.size());
  EXPECT_THAT(error_of([&] { treat_unseen(mesh, cameras, {}); }),
              testing::HasSubstr("no two cameras see the front of a face"));
}

TEST(Unseen, SmallHolesAreNotMade) {
  Mesh mesh = plate(60, 0, 1);
  const std::size_t below = mesh.faces.size();
  append(mesh, plate(2, 0, 0.5f));
  const auto cameras = cameras_at({0, 0.001}, false);
  const std::vector<std::uint8_t> all = unseen_faces(mesh, cameras, holes(0));
  ASSERT_GT(count(all), 4u);
  EXPECT_EQ(count({all.begin() + static_cast<std::ptrdiff_t>(below), all.end()}), 0u);
  // The shadow is about 0.04 wide. The longest edges are 0.014 long.
  EXPECT_EQ(count(unseen_faces(mesh, cameras, holes(2))), count(all));
  EXPECT_EQ(count(unseen_faces(mesh, cameras, holes(8))), 0u);
}

// A wall of the size 0.2 behind the plate of 60 x 60, of faces as large as those of the plate or
// ten times as large. The cameras see its front at 73 degrees or more from its normal. If `folded`
// is true, its far half is turned away from the cameras.
Mesh wall_of(bool large, bool folded) {
  Mesh wall = plate(large ? 2 : 20, 0, 0);
  const float size = large ? 10.0f : 1.0f;
  for (Eigen::Vector3f& v : wall.vertices) {
    const float u = size * v.x(), y = size * v.y();
    if (folded && u < 0)
      v = {0.8f - 0.4f * u, y, 1 - 0.92f * u};
    else
      v = {0.8f + 0.17f * u, y, 1 - 0.98f * u};
  }
  return wall;
}

// The surface that closes an unseen place often begins along the last rays, and has large faces.
TEST(Unseen, LargeFacesBesideUnseenOnesMustBeSeenAtASteeperAngle) {
  const std::vector<geometry::PosedCamera> cameras = cameras_at({0.7, 0.72}, false);
  const Mesh level = plate(60, 0, 1);
  const auto marked = [&](const Mesh& wall, bool large_faces) {
    Mesh mesh = level;
    append(mesh, wall);
    UnseenOptions options = holes(0);
    options.sizes_tell = large_faces;
    const auto unseen = unseen_faces(mesh, cameras, options);
    return count({unseen.begin() + static_cast<std::ptrdiff_t>(level.faces.size()), unseen.end()});
  };
  const Mesh large = wall_of(true, true), fine = wall_of(false, true);
  EXPECT_EQ(marked(large, true), large.faces.size());
  EXPECT_EQ(marked(large, false), large.faces.size() / 2) << "sizes that say nothing";
  EXPECT_EQ(marked(fine, true), fine.faces.size() / 2) << "points prove the near half";
  EXPECT_EQ(marked(wall_of(true, false), true), 0u) << "true surface with little texture";
  EXPECT_EQ(marked(wall_of(false, false), true), 0u);
}

// All vertices are points: the noise of the mesh hides a face, not the lack of a measurement.
TEST_P(Unseen, FacesNearPointsWereMeasured) {
  Mesh mesh = plate(80, 0, 1);
  append(mesh, plate(20, 0, 0.5f));
  const auto cameras = cameras_at({-0.02, 0, 0.02}, GetParam());
  UnseenOptions options = holes(0);
  options.points = mesh.vertices;
  EXPECT_EQ(count(unseen_faces(mesh, cameras, options)), 0u);
  std::vector<Eigen::Vector3f> outside;
  for (const Eigen::Vector3f& v : mesh.vertices)
    if (v.z() < 0.9f || std::max(std::abs(v.x()), std::abs(v.y())) > 0.145f) outside.push_back(v);
  options.points = outside;
  const std::vector<std::uint8_t> unseen = unseen_faces(mesh, cameras, options);
  // The middle of a face is 0.0047 from its nearest corner: the median distance.
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    for (const std::uint32_t v : mesh.faces[f]) middle += mesh.vertices[v] / 3;
    const float aside = std::max(std::abs(middle.x()), std::abs(middle.y()));
    const bool hidden = middle.z() > 0.9f;
    EXPECT_TRUE(unseen[f] == 1 || !hidden || aside > 0.15f - 10 * 0.0047f) << middle.transpose();
    EXPECT_TRUE(unseen[f] == 0 || (hidden && aside < 0.15f - 8 * 0.0047f)) << middle.transpose();
  }
  options.sizes_tell = false;
  EXPECT_EQ(unseen_faces(mesh, cameras, options), unseen_faces(mesh, cameras, holes(0)))
      << "a decimated mesh says nothing about its points";
  // One point for about 50 faces: those of another cloud, or sparse ones.
  std::vector<Eigen::Vector3f> sparse;
  for (std::size_t v = 0; v < mesh.vertices.size(); v += 25) sparse.push_back(mesh.vertices[v]);
  options.points = sparse;
  options.sizes_tell = true;
  EXPECT_EQ(unseen_faces(mesh, cameras, options), unseen_faces(mesh, cameras, holes(0)));
}

// Two cameras see the near half of the folded wall, and all of the whole one, at a cosine of about
// 0.4, or about 0.2 if they are above the wall.
TEST(Unseen, GrazingFacesFarFromPointsAreUnseen) {
  const auto aside = cameras_at({0.55, 0.57}, false), above = cameras_at({0.76, 0.78}, false);
  const Mesh level = plate(60, 0, 1), folded = wall_of(false, true), whole = wall_of(false, false);
  const auto marked = [&](const Mesh& wall, const auto& cameras, auto&& is_point) {
    Mesh mesh = level;
    append(mesh, wall);
    std::vector<Eigen::Vector3f> points = level.vertices;
    std::ranges::copy_if(wall.vertices, std::back_inserter(points), is_point);
    UnseenOptions options = holes(0);
    options.points = points;
    const auto unseen = unseen_faces(mesh, cameras, options);
    return static_cast<double>(
        count({unseen.begin() + static_cast<std::ptrdiff_t>(level.faces.size()), unseen.end()}));
  };
  const auto none = [](const auto&) { return false; };
  const auto all = [](const auto&) { return true; };
  const auto near_half = [](const Eigen::Vector3f& v) { return v.z() < 1.001f; };
  const auto faces = static_cast<double>(folded.faces.size());
  EXPECT_EQ(marked(folded, aside, none), faces) << "the near half is connected to the far half";
  EXPECT_EQ(marked(whole, aside, none), 0) << "true surface with little texture";
  EXPECT_EQ(marked(whole, above, none), faces);
  EXPECT_EQ(marked(folded, above, all), 0);
  // So has the part of the far half next to it: 9 x 0.0047 of 0.1.
  EXPECT_NEAR(marked(folded, aside, near_half), 0.58 * faces / 2, faces / 20);
}

TEST(Unseen, EveryKthPointIsTaken) {
  for (const std::size_t all : {1u, 99u, 100u, 101u, 1000u, 1001u})
    for (const std::size_t portion : {1u, 7u, 5000u}) {
      const std::vector<Eigen::Vector3f> some = some_positions(
          [&](const io::CloudPortionSink& sink) {
            for (std::size_t begin = 0; begin < all; begin += portion) {
              PointCloud cloud;
              for (std::size_t i = begin; i < std::min(all, begin + portion); ++i)
                cloud.positions.emplace_back(static_cast<float>(i), 0, 0);
              sink(std::move(cloud), all);
            }
          },
          100);
      const std::size_t step = (all + 99) / 100;
      ASSERT_EQ(some.size(), (all + step - 1) / step) << all << " in portions of " << portion;
      EXPECT_LE(some.size(), 100u);
      for (std::size_t i = 0; i < some.size(); ++i)
        EXPECT_EQ(some[i].x(), static_cast<float>(i * step));
    }
}

TEST(Unseen, PiecesThatAreCutOffAreRemoved) {
  Mesh mesh = plate(60, 0, 1);
  std::vector<std::uint8_t> unseen(mesh.faces.size(), 0);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    float x = 0;
    for (const std::uint32_t v : mesh.faces[f]) x += mesh.vertices[v].x() / 3;
    unseen[f] = x > 0.2f && x < 0.25f;
  }
  UnseenReport report;
  // The strip of 0.05 x 0.6 beside the gap has a diagonal of 53 mean edges of 0.0114.
  // A corner of a part may hang on it by one edge.
  const auto left = [&](double cut_off) {
    return static_cast<double>(without_unseen(mesh, unseen, cut_off, &report).faces.size());
  };
  EXPECT_NEAR(left(20), 60 * 55 * 2, 4);
  EXPECT_EQ(report.pieces, 0u);
  EXPECT_NEAR(left(60), 60 * 50 * 2, 4);
  EXPECT_EQ(report.pieces, 1u);
}

TEST(Unseen, AnyMarksLeaveAManifoldMesh) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 40; ++trial) {
    const Mesh mesh = plate(12, 0, 1);
    std::vector<std::uint8_t> unseen(mesh.faces.size());
    std::bernoulli_distribution marked(0.02 * trial);
    for (std::uint8_t& mark : unseen) mark = marked(random);
    const test::MeshFacts facts = test::facts_of(without_unseen(mesh, unseen, 0));
    EXPECT_EQ(facts.bad_edges + facts.bad_vertices + facts.unused_vertices, 0u) << trial;
  }
}

TEST(Unseen, MarksAreKeptInsteadIfWanted) {
  Mesh mesh = plate(40, 0, 1);
  append(mesh, plate(10, 0, 0.5f));
  const auto cameras = cameras_at({0, 0.01}, false);
  const Mesh kept = treat_unseen(mesh, cameras, {.keep = true, .small_holes = 0});
  EXPECT_EQ(kept.faces, mesh.faces);
  EXPECT_EQ(kept.unseen, unseen_faces(mesh, cameras, holes(0)));
  const Mesh removed = treat_unseen(mesh, cameras, {.small_holes = 0});
  EXPECT_TRUE(removed.unseen.empty());
  EXPECT_LT(removed.faces.size(), mesh.faces.size());
  // One camera cannot tell.
  const Mesh untold = treat_unseen(kept, std::span(cameras).first(1), {});
  EXPECT_EQ(untold.faces, mesh.faces);
  EXPECT_TRUE(untold.unseen.empty());
}

TEST(Unseen, DoesNotDependOnThreads) {
  Mesh mesh = plate(60, 0, 1);
  append(mesh, plate(20, 0, 0.5f));
  const auto cameras = cameras_at({-0.1, 0, 0.1}, true);
  std::vector<std::uint8_t> alone;
  {
    const ThreadLimit one(1);
    alone = unseen_faces(mesh, cameras, holes(5));
  }
  const ThreadLimit four(4);
  EXPECT_EQ(unseen_faces(mesh, cameras, holes(5)), alone);
}

}  // namespace
}  // namespace axial::mesh
