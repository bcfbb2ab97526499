// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes that are textured tile by tile, beside the same mesh textured in one piece.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "geometry/faces.h"
#include "support/error_of.h"
#include "texture/faces/face_labels.h"
#include "texture/faces/face_views.h"
#include "texture/painted_room.h"

namespace axial::texture {
namespace {

using Position = std::array<float, 3>;
using Corners = std::array<Position, 3>;  // the positions of a face's corners

const std::vector<float> kExposures{0.8f, 1, 1.15f, 0.9f, 1.05f, 0.85f};

Corners corners_of(const Mesh& mesh, std::size_t face) {
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3f& x = mesh.vertices[mesh.faces[face][k]];
    corners[k] = {x.x(), x.y(), x.z()};
  }
  return corners;
}

std::vector<TexturedMesh> in_tiles(const Mesh& mesh, const test::Room& room, Options options,
                                   std::size_t tiles, Report* report = nullptr,
                                   const Context& context = {}) {
  options.tiles = tiles;
  std::vector<TexturedMesh> result;
  texture_tiles(
      mesh, room.views, room.source(), options,
      [&](std::size_t tile, TexturedMesh textured) {
        EXPECT_EQ(tile, result.size());
        result.push_back(std::move(textured));
      },
      report, context);
  EXPECT_EQ(result.size(), tiles);
  return result;
}

// The room, and faces under the floor that no view sees.
Mesh room_with_unseen_faces() {
  Mesh mesh = test::refined(test::room_mesh(), 4);
  for (const float x : {-0.7f, 0.0f, 0.7f}) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {{x, 0, -1}, {x + 0.1f, 0, -1}, {x, 0.1f, -1}});
    mesh.faces.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

TEST(TextureTiles, EachFaceIsInOneTileAtTheSamePlace) {
  const test::Room room = test::photograph_room(6, kExposures);
  Report report;
  const auto tiles = in_tiles(room_with_unseen_faces(), room, {}, 4, &report);
  const TexturedMesh whole = texture_mesh(room_with_unseen_faces(), room.views, room.source());
  std::map<Corners, std::size_t> index;
  for (std::size_t f = 0; f < whole.mesh.faces.size(); ++f) index[corners_of(whole.mesh, f)] = f;
  ASSERT_EQ(index.size(), whole.mesh.faces.size());
  std::vector<int> times(whole.mesh.faces.size(), 0);
  for (const TexturedMesh& tile : tiles) {
    EXPECT_FALSE(tile.mesh.faces.empty());
    ASSERT_EQ(tile.uv.size(), tile.mesh.faces.size());
    std::vector<bool> used(tile.mesh.vertices.size(), false);
    std::size_t last = 0;
    for (std::size_t f = 0; f < tile.mesh.faces.size(); ++f) {
      const auto found = index.find(corners_of(tile.mesh, f));
      ASSERT_NE(found, index.end());
      EXPECT_GE(found->second, last);  // in the same order
      last = found->second;
      ++times[last];
      for (const std::uint32_t v : tile.mesh.faces[f]) used[v] = true;
    }
    EXPECT_THAT(used, testing::Each(true));
  }
  EXPECT_THAT(times, testing::Each(1));
  EXPECT_GE(report.unseen_faces, 3u);
}

// The place in the texture of a tile, as a whole number of pixels from the place in one piece.
std::optional<cv::Point> moved_by(const TexturedMesh& from, std::size_t f, const TexturedMesh& to,
                                  std::size_t g) {
  const Eigen::Vector2f way = to.uv[g][0] - from.uv[f][0];
  const Eigen::Vector2f whole = way.array().round();
  for (std::size_t k = 0; k < 3; ++k)
    if (!((to.uv[g][k] - from.uv[f][k] - whole).norm() < 1e-3f)) return {};
  return cv::Point(static_cast<int>(whole.x()), static_cast<int>(whole.y()));
}

// The pixels around a face, up to two pixels from it.
cv::Rect around(const TexturedMesh::Corners& uv) {
  const Eigen::Vector2f low = uv[0].cwiseMin(uv[1]).cwiseMin(uv[2]);
  const Eigen::Vector2f high = uv[0].cwiseMax(uv[1]).cwiseMax(uv[2]);
  const cv::Point first(static_cast<int>(std::floor(low.x())) - 2,
                        static_cast<int>(std::floor(low.y())) - 2);
  return {first, cv::Point(static_cast<int>(std::ceil(high.x())) + 3,
                           static_cast<int>(std::ceil(high.y())) + 3)};
}

// Each face gets its best view, so that views do not depend on tiles.
TEST(TextureTiles, WithTheSameViewsThePixelsAreThoseOfOnePiece) {
  const test::Room room = test::photograph_room(6, kExposures);
  const Mesh mesh = room_with_unseen_faces();
  Options options;
  options.labels.max_cycles = 0;
  options.packing.max_size = 128;  // several textures
  const TexturedMesh whole = texture_mesh(mesh, room.views, room.source(), options);
  EXPECT_GT(whole.textures.size(), 2u);
  std::map<Corners, std::size_t> index;
  for (std::size_t f = 0; f < whole.mesh.faces.size(); ++f) index[corners_of(whole.mesh, f)] = f;
  for (const std::size_t count : {2u, 5u})
    for (const TexturedMesh& tile : in_tiles(mesh, room, options, count))
      for (std::size_t g = 0; g < tile.mesh.faces.size(); ++g) {
        const std::size_t f = index.at(corners_of(tile.mesh, g));
        const auto moved = moved_by(whole, f, tile, g);
        ASSERT_TRUE(moved);
        const bool unseen = (whole.uv[f][1] - whole.uv[f][0]).norm() == 0;
        const cv::Rect rect = unseen ? cv::Rect(0, 0, 2, 2) : around(whole.uv[f]);
        const cv::Mat3b one = whole.textures[whole.texture_of[f]](rect);
        const cv::Mat3b other = tile.textures[tile.texture_of[g]](rect + *moved);
        ASSERT_EQ(cv::norm(one, other, cv::NORM_INF), 0) << "face " << f;
      }
}

// A face in the mesh of a tile.
struct TileFace {
  std::size_t tile, face;
};

std::map<Corners, TileFace> places_in(const std::vector<TexturedMesh>& tiles) {
  std::map<Corners, TileFace> places;
  for (std::size_t t = 0; t < tiles.size(); ++t)
    for (std::size_t f = 0; f < tiles[t].mesh.faces.size(); ++f)
      places[corners_of(tiles[t].mesh, f)] = {t, f};
  return places;
}

// The mean difference of colours at the middles of edges between two tiles [grey levels]. `whole`
// is the mesh of all tiles, whose neighbours are connected.
double mean_step_between(const std::vector<TexturedMesh>& tiles, const Mesh& whole) {
  const std::map<Corners, TileFace> places = places_in(tiles);
  double sum = 0;
  std::size_t count = 0;
  for (const FacePair& pair : face_pairs(whole.faces)) {
    const auto color = [&](const TileFace& place, std::uint32_t face) {
      Eigen::Vector3f weights = Eigen::Vector3f::Zero();
      for (std::size_t k = 0; k < 3; ++k)
        if (whole.faces[face][k] == pair.from || whole.faces[face][k] == pair.to)
          weights[static_cast<int>(k)] = 0.5f;
      return test::color_at(tiles[place.tile], place.face, weights);
    };
    const TileFace a = places.at(corners_of(whole, pair.a)),
                   b = places.at(corners_of(whole, pair.b));
    if (a.tile == b.tile) continue;
    const auto of_a = color(a, pair.a), of_b = color(b, pair.b);
    if (!of_a || !of_b) continue;
    sum += (*of_a - *of_b).cwiseAbs().mean();
    ++count;
  }
  EXPECT_GT(count, 30u);
  return sum / static_cast<double>(count);
}

// The limits are those of seams in one piece (leveling_test.cpp).
TEST(TextureTiles, SeamsBetweenTilesVanish) {
  const test::Room room = test::photograph_room(6, kExposures);
  Mesh mesh = test::refined(test::room_mesh(), 4);
  split_faces(mesh, room.views, {}, {});
  EXPECT_GT(mean_step_between(in_tiles(mesh, room, test::plain_options(), 4), mesh), 10);
  EXPECT_LT(mean_step_between(in_tiles(mesh, room, {}, 4), mesh), 2.5);
}

TEST(TextureTiles, ResultsAreTheSameForAnyNumberOfThreads) {
  const test::Room room = test::photograph_room(5, {1, 0.8f, 1.1f, 0.9f, 1});
  const auto run = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    return in_tiles(test::refined(test::room_mesh(), 4), room, {}, 3);
  };
  const auto one = run(1), two = run(2);
  for (std::size_t t = 0; t < one.size(); ++t) {
    EXPECT_EQ(one[t].mesh.faces, two[t].mesh.faces);
    EXPECT_EQ(one[t].uv, two[t].uv);
    ASSERT_EQ(one[t].textures.size(), two[t].textures.size());
    for (std::size_t k = 0; k < one[t].textures.size(); ++k)
      EXPECT_EQ(cv::norm(one[t].textures[k], two[t].textures[k], cv::NORM_INF), 0);
  }
}

bool same_sight(const Sight& a, const Sight& b) {
  return a.view == b.view && a.quality == b.quality && a.color == b.color && a.whole == b.whole;
}

// The box hides parts of the floor although only faces of the floor are looked at.
TEST(TextureTiles, ThePartOfAMeshHasTheSightsOfTheWhole) {
  const test::Room room = test::photograph_room(4);
  const Mesh mesh = test::refined(test::room_mesh(), 4);
  const FaceViews all = find_face_views(mesh, room.views, room.source());
  std::vector<std::uint32_t> floor(mesh.faces.size() / 6);
  std::iota(floor.begin(), floor.end(), 0u);
  const FaceViews part = find_face_views(mesh_of_faces(mesh, floor), Surroundings(mesh), room.views,
                                         room.source(), {}, {}, {});
  ASSERT_EQ(part.faces(), floor.size());
  std::size_t hidden = 0;
  for (const std::uint32_t f : floor) {
    const auto expected = all.of(f), found = part.of(f);
    EXPECT_TRUE(std::ranges::equal(expected, found, same_sight));
    if (expected.size() < 4 && geometry::middle_of(mesh, f).norm() < 0.5) ++hidden;
  }
  EXPECT_GT(hidden, 10u);
}

TEST(TextureTiles, PhotographsThatDoNotShowAFaceAreNotRead) {
  test::Room room = test::photograph_room(3);
  room.views[1].pose.centre.x() += 100;
  const auto images = [&](std::size_t v) {
    EXPECT_NE(v, 1u);
    return room.images[v];
  };
  EXPECT_FALSE(find_face_views(test::room_mesh(), room.views, images).sights.empty());
}

std::vector<std::uint32_t> labels_in(const Mesh& mesh, const test::Room& room, std::size_t count) {
  const auto images = room.source();
  const Options options;
  Report report;
  const auto labels =
      label_faces(mesh, face_pairs(mesh.faces), divide_faces(mesh, count, options.axes),
                  {room.views, images, options, {}}, {}, report);
  return labels;
}

// The margin is smaller than the tiles.
TEST(TextureTiles, MostViewsOfFacesAreThoseOfOnePiece) {
  const test::Room room = test::photograph_room(6);
  const Mesh mesh = test::refined(test::room_mesh(), 6);
  const auto whole = labels_in(mesh, room, 1), tiled = labels_in(mesh, room, 4);
  std::size_t different = 0;
  for (std::size_t f = 0; f < whole.size(); ++f) different += whole[f] != tiled[f];
  EXPECT_LT(static_cast<double>(different), 0.02 * static_cast<double>(whole.size()));
  const auto seams = [&](const std::vector<std::uint32_t>& labels) {
    std::size_t count = 0;
    for (const FacePair& pair : face_pairs(mesh.faces)) count += labels[pair.a] != labels[pair.b];
    return static_cast<double>(count);
  };
  EXPECT_LT(seams(tiled), 1.02 * seams(whole));
}

TEST(TextureTiles, ATileMayHaveNoFaces) {
  const test::Room room = test::photograph_room(3);
  Mesh mesh;
  mesh.vertices = {{-0.1f, -0.1f, 0.2f}, {0.1f, -0.1f, 0.2f}, {0, 0.1f, 0.2f}};
  mesh.faces = {{0, 1, 2}};
  std::size_t faces = 0, empty = 0;
  Options options;
  options.split.tolerance = 1e9;
  for (const TexturedMesh& tile : in_tiles(mesh, room, options, 5)) {
    faces += tile.mesh.faces.size();
    if (!tile.mesh.faces.empty()) continue;
    ++empty;
    EXPECT_TRUE(tile.textures.empty());
  }
  EXPECT_EQ(faces, 1u);
  EXPECT_EQ(empty, 4u);
}

// Writing needs more than the other stages. A quarter of it is within the limit.
TEST(TextureTiles, TilesNeedLessMemory) {
  const test::Room room = test::photograph_room(4);
  const Mesh mesh = test::refined(test::room_mesh(), 4);
  Options options;
  const Context context({}, {}, {MemoryBudget::of_bytes(20'000'000)});
  options.bytes_to_write = [](const ResultSize& size) { return 10'000 * size.faces; };
  EXPECT_THAT(test::error_of([&] { in_tiles(mesh, room, options, 1, nullptr, context); }),
              testing::MatchesRegex("max_memory: writing 1 textures needs [0-9]+ MB more; a larger "
                                    "tiles needs less memory"));
  in_tiles(mesh, room, options, 4, nullptr, context);
}

TEST(TextureTiles, AMeshThatNoViewSeesIsRefused) {
  const test::Room room = test::photograph_room(2);
  Mesh mesh = test::room_mesh();
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex.z() += 100;
  EXPECT_THAT(test::error_of([&] { in_tiles(mesh, room, {}, 3); }),
              testing::HasSubstr("no view sees a face"));
}

}  // namespace
}  // namespace axial::texture
