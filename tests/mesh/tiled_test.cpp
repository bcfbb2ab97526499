// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/tiled.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "base/error.h"
#include "base/parallel.h"
#include "mesh/tile_files.h"
#include "mesh/tile_mesh.h"
#include "sphere_cloud.h"
#include "support/empty_folder.h"
#include "support/error_of.h"
#include "topology.h"
#include "worlds/height_field.h"

namespace axial::mesh {
namespace {

using test::error_of;
using test::kSphereRadius;
using testing::HasSubstr;

double volume_of(const Mesh& mesh) {
  double sum = 0;
  for (const auto& face : mesh.faces)
    sum += mesh.vertices[face[0]].cast<double>().dot(
               mesh.vertices[face[1]].cast<double>().cross(mesh.vertices[face[2]].cast<double>())) /
           6;
  return sum;
}

// The faces by the positions of their corners, so that two meshes can be compared.
std::multiset<std::vector<float>> faces_of(const Mesh& mesh) {
  std::multiset<std::vector<float>> faces;
  for (const auto& face : mesh.faces) {
    std::array<std::vector<float>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k].assign(mesh.vertices[face[k]].begin(), mesh.vertices[face[k]].end());
    std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
    std::vector<float> all;
    for (const auto& corner : corners) all.insert(all.end(), corner.begin(), corner.end());
    faces.insert(all);
  }
  return faces;
}

// Passes a cloud in portions of 1,000 points.
CloudSource portions_of(const PointCloud& cloud) {
  return [&cloud](const io::CloudPortionSink& sink) {
    for (std::size_t first = 0; first < cloud.size(); first += 1000) {
      PointCloud portion;
      portion.view_begin.push_back(0);
      for (std::size_t i = first; i < std::min(first + 1000, cloud.size()); ++i) {
        portion.positions.push_back(cloud.positions[i]);
        portion.normals.push_back(cloud.normals[i]);
        const auto views = cloud.views_of(i);
        portion.view_images.insert(portion.view_images.end(), views.begin(), views.end());
        portion.view_begin.push_back(portion.view_images.size());
      }
      sink(std::move(portion), cloud.size());
    }
  };
}

class Tiled : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override { folder_ = test::empty_folder(); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  TileRun run_of(std::size_t tiles, const std::string& made_from = "test") const {
    return {.tiles = tiles, .folder = folder_ / "tiles", .made_from = made_from, .margin = 40};
  }
  Mesh in_tiles(const PointCloud& cloud, std::size_t tiles, double min_distance) const {
    std::filesystem::remove_all(folder_ / "tiles");
    return reconstruct_in_tiles(portions_of(cloud), scene_, merging(min_distance), run_of(tiles));
  }
  static ReconstructOptions merging(double min_distance) {
    ReconstructOptions options;
    options.merge.min_distance = min_distance;
    return options;
  }

  Scene scene_ = test::cameras_around_sphere(GetParam());
  std::filesystem::path folder_;
};
INSTANTIATE_TEST_SUITE_P(Media, Tiled, testing::Bool());

// Without merging, the tetrahedra of tiles are those of the whole. So are the faces: the
// noise-free sphere has no other surface.
TEST_P(Tiled, ASphereInTilesHasTheFacesOfASphereInOnePiece) {
  const PointCloud cloud = test::points_on_sphere(scene_, 6000);
  const Mesh whole = reconstruct(cloud, scene_, merging(0));
  for (const std::size_t tiles : {1u, 2u, 5u})
    EXPECT_EQ(faces_of(in_tiles(cloud, tiles, 0)), faces_of(whole)) << tiles << " tiles";
}

void expect_closed_sphere(const Mesh& mesh, const Mesh& whole) {
  const test::MeshFacts facts = test::facts_of(mesh);
  EXPECT_EQ(facts.border_edges, 0u);
  EXPECT_EQ(facts.bad_edges + facts.bad_vertices + facts.unused_vertices, 0u);
  EXPECT_EQ(facts.euler, 2);
  EXPECT_NEAR(volume_of(mesh) / volume_of(whole), 1, 2e-3);  // 0.1 mm of 300 mm
}

TEST_P(Tiled, ANoisySphereIsClosedManifoldAndRound) {
  const PointCloud cloud = test::points_on_sphere(scene_, 20000, 0.002);
  const Mesh whole = reconstruct(cloud, scene_, merging(1.5));
  expect_closed_sphere(in_tiles(cloud, 7, 1.5), whole);
  // Within so small a margin, the meshes of neighbouring tiles differ.
  TileRun run = run_of(7, "small margin");
  run.margin = 10;
  expect_closed_sphere(reconstruct_in_tiles(portions_of(cloud), scene_, merging(1.5), run), whole);
}

TEST_P(Tiled, RunsForTilesGiveTheBytesOfOneRun) {
  const PointCloud cloud = test::points_on_sphere(scene_, 8000, 0.002);
  Mesh whole;
  {
    const ThreadLimit limit(1);
    whole = in_tiles(cloud, 3, 2);
  }
  std::filesystem::remove_all(folder_ / "tiles");
  const ThreadLimit limit(4);
  for (const std::size_t tile : {2u, 0u, 1u})
    reconstruct_tile(tile, portions_of(cloud), scene_, merging(2), run_of(3));
  // All tiles are there: the cloud is not read again.
  const CloudSource none = [](const io::CloudPortionSink&) { FAIL(); };
  const Mesh joined = reconstruct_in_tiles(none, scene_, merging(2), run_of(3));
  EXPECT_EQ(joined.vertices, whole.vertices);
  EXPECT_EQ(joined.faces, whole.faces);
}

TEST_P(Tiled, FilesOfOtherInputAndDamagedFilesAreMadeAgain) {
  const PointCloud cloud = test::points_on_sphere(scene_, 3000);
  const PointCloud other = test::points_on_sphere(scene_, 4000);
  const Mesh whole = in_tiles(other, 2, 0);
  in_tiles(cloud, 2, 0);
  const TileRun run = run_of(2, "the other cloud");
  EXPECT_EQ(faces_of(reconstruct_in_tiles(portions_of(other), scene_, merging(0), run)),
            faces_of(whole));
  std::filesystem::path changed;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(run.folder))
    if (entry.path().filename() == "mesh1.bin") changed = entry.path();
  const TileFiles files(run.folder, changed.parent_path().filename().string());
  EXPECT_TRUE(files.has_others());
  std::fstream file(changed, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(200);
  file.put('\7');
  file.close();
  EXPECT_NE(files.mesh(0).has_value(), files.mesh(1).has_value());
  EXPECT_EQ(faces_of(reconstruct_in_tiles(portions_of(other), scene_, merging(0), run)),
            faces_of(whole));
  remove_intermediate_files(run);
  EXPECT_FALSE(std::filesystem::exists(run.folder));
}

// The first portions are outside of the region.
TEST_P(Tiled, PointsOutsideTheRegionAreNotUsed) {
  scene_.region = OrientedBox{.centre = {0, 0, -0.95}, .half_extent = {1, 1, 1}};
  ReconstructOptions options = merging(1.5);
  options.only_region = true;
  const PointCloud cloud = test::points_on_sphere(scene_, 8000, 0.001);
  const Mesh whole = reconstruct(cloud, scene_, options);
  const Mesh tiled = reconstruct_in_tiles(portions_of(cloud), scene_, options, run_of(3));
  // Points at both sides of borders are not merged, so a few faces differ.
  const auto faces = static_cast<double>(whole.faces.size());
  EXPECT_NEAR(static_cast<double>(tiled.faces.size()) / faces, 1, 0.03);
}

TEST_P(Tiled, TilesMayBeEmpty) {
  const PointCloud few = test::points_on_sphere(scene_, 100);
  ReconstructOptions options = merging(0);
  options.clean.spurious = options.clean.cut_off = 0;
  const Mesh whole = reconstruct(few, scene_, options);
  EXPECT_GT(whole.faces.size(), 50u);
  // A margin of all points, and more tiles than points.
  TileRun run = run_of(130);
  run.margin = 1e4;
  EXPECT_EQ(faces_of(reconstruct_in_tiles(portions_of(few), scene_, options, run)),
            faces_of(whole));
}

TEST_P(Tiled, WrongInputIsRefused) {
  PointCloud cloud = test::points_on_sphere(scene_, 3000);
  ReconstructOptions options = merging(0);
  options.clean.decimate = 0.5;
  EXPECT_THAT(
      error_of([&] { reconstruct_in_tiles(portions_of(cloud), scene_, options, run_of(2)); }),
      HasSubstr("cannot be simplified"));
  options = merging(0);
  const Context context({}, {}, {MemoryBudget::of_bytes(bytes_needed(300))});
  EXPECT_THAT(error_of([&] {
                reconstruct_in_tiles(portions_of(cloud), scene_, options, run_of(2), context);
              }),
              HasSubstr("max_memory is 60"));
  cloud.view_images[cloud.view_begin[2500]] = 77;
  EXPECT_THAT(error_of([&] { in_tiles(cloud, 2, 0); }), HasSubstr("point 2500 names view 77"));
}

// A strip of triangles, of which the tiles see different versions.
class Join : public testing::Test {
 protected:
  // A plane of 2 x `n` x `n` triangles, 1 m wide, whose height at the middle vertex is `height`.
  static Mesh plane(int n, float height) {
    const double half = std::floor(n / 2.0);
    return test::height_field(
        {0, 0}, Eigen::Vector2d::Constant(n), static_cast<std::uint32_t>(n),
        [&](double x, double y) { return x == half && y == half ? height : 0.0f; });
  }
  static std::array<cloud::Tile, 2> halves(double at) {
    std::array<cloud::Tile, 2> tiles;
    tiles[0].high.x() = tiles[1].low.x() = at;
    return tiles;
  }
};

TEST_F(Join, EachFaceBelongsToOneTile) {
  const Mesh mesh = plane(20, 0.3f);
  const auto tiles = halves(10.2);
  JoinReport report;
  const Mesh joined =
      join_tiles({owned_part(mesh, tiles[0]), owned_part(mesh, tiles[1])}, {}, &report);
  EXPECT_EQ(faces_of(joined), faces_of(mesh));
  EXPECT_EQ(joined.vertices.size(), mesh.vertices.size());
  EXPECT_GT(report.seams, 19u);
  EXPECT_EQ(report.unmatched, 0u);
  EXPECT_EQ(report.replaced_faces, 0u);
}

TEST_F(Join, GapsWhereTilesDifferAreClosed) {
  const auto tiles = halves(10.2);
  JoinReport report;
  const Mesh joined = join_tiles(
      {owned_part(plane(20, 0.3f), tiles[0]), owned_part(plane(20, 0.8f), tiles[1])}, {}, &report);
  EXPECT_GT(report.unmatched, 0u);
  const test::MeshFacts facts = test::facts_of(joined);
  EXPECT_EQ(facts.border_edges, 80u);  // those of the plane
  EXPECT_EQ(facts.bad_edges + facts.bad_vertices + facts.unused_vertices, 0u);
  EXPECT_EQ(facts.euler, 1);
  // Faces far from the difference stay.
  const auto before = faces_of(plane(20, 0)), after = faces_of(joined);
  std::size_t kept = 0;
  for (const auto& face : before) kept += after.count(face);
  EXPECT_GT(kept, before.size() - 60);
}

TEST_F(Join, SmallPiecesAreRemoved) {
  Mesh small = plane(4, 0);
  for (Eigen::Vector3f& vertex : small.vertices) vertex.x() += 50;
  JoinReport report;
  const auto tiles = halves(30);
  const TileMesh large = owned_part(plane(40, 0), tiles[0]);
  const Mesh joined = join_tiles({large, owned_part(small, tiles[1])}, {}, &report);
  EXPECT_EQ(report.removed_components, 1u);
  EXPECT_EQ(faces_of(joined), faces_of(large.mesh));
}

}  // namespace
}  // namespace axial::mesh
