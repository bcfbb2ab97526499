// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <set>

#include "axial/texture.h"
#include "base/error.h"
#include "base/parallel.h"
#include "support/error_of.h"
#include "texture/faces/face_views.h"
#include "texture/painted_room.h"

namespace axial::texture {
namespace {

using testing::HasSubstr;

double area(const Mesh& mesh, std::size_t face) {
  const auto& [a, b, c] = mesh.faces[face];
  const Eigen::Vector3f& at = mesh.vertices[a];
  return 0.5 * static_cast<double>((mesh.vertices[b] - at).cross(mesh.vertices[c] - at).norm());
}

struct Errors {
  float median, of_95_percent;
};

Errors summary(const std::vector<float>& errors) {
  EXPECT_GT(errors.size(), 1000u);
  return {errors[errors.size() / 2], errors[errors.size() * 95 / 100]};
}

// Between pixels, interpolation of a wave of 10 cm, about 15 pixels long, is wrong by up to 2 % of
// its amplitude of 51 levels, and the mean over a pixel by as much; rounding adds half a level.
TEST(TextureMesh, ColoursThroughAPortAreThoseOfTheSurface) {
  const test::Room room = test::photograph_room(6);
  Report report;
  const TexturedMesh mesh = texture_mesh(test::room_mesh(), room.views, room.source(), {}, &report);
  const Errors errors = summary(test::color_errors(mesh));
  EXPECT_LT(errors.median, 2);
  EXPECT_LT(errors.of_95_percent, 5);
  EXPECT_GT(report.new_faces, 0u);
  EXPECT_LT(report.unseen_faces, mesh.mesh.faces.size() / 4);
}

// The views are those of the faces of the textured mesh, and they are not found a second time.
TEST(TextureMesh, GivesTheViewsOfItsFaces) {
  const test::Room room = test::photograph_room(6);
  FaceViews taken;
  Options options;
  options.take_views = [&](const Mesh& mesh, const FaceViews& views) {
    EXPECT_EQ(views.faces(), mesh.faces.size());
    taken = views;
  };
  const TexturedMesh mesh = texture_mesh(test::room_mesh(), room.views, room.source(), options);
  const FaceViews seen = find_face_views(mesh.mesh, room.views, room.source());
  EXPECT_EQ(taken.begin, seen.begin);
  ASSERT_EQ(taken.sights.size(), seen.sights.size());
  for (std::size_t i = 0; i < seen.sights.size(); ++i)
    EXPECT_EQ(taken.sights[i].view, seen.sights[i].view);
}

TEST(TextureMesh, ColoursThroughADomeAreThoseOfTheSurface) {
  const test::Room room = test::photograph_room(6, {}, test::room_dome());
  const TexturedMesh mesh = texture_mesh(test::room_mesh(), room.views, room.source());
  const Errors errors = summary(test::color_errors(mesh));
  EXPECT_LT(errors.median, 2);
  EXPECT_LT(errors.of_95_percent, 5);
}

TEST(TextureMesh, WithThePortIgnoredColoursAreWrong) {
  test::Room room = test::photograph_room(6);
  for (View& view : room.views) view.camera.port.reset();
  const TexturedMesh mesh = texture_mesh(test::room_mesh(), room.views, room.source());
  EXPECT_GT(summary(test::color_errors(mesh)).median, 15);
}

// The box hides parts of the floor from each view, and is 77 levels more red.
TEST(TextureMesh, HiddenPartsOfTheFloorDoNotGetTheColourOfTheBox) {
  const test::Room room = test::photograph_room(6);
  const TexturedMesh mesh = texture_mesh(test::refined(test::room_mesh(), 4), room.views,
                                         room.source(), test::plain_options());
  std::size_t floor = 0, reddish = 0;
  test::for_each_color(
      mesh, [&](std::size_t, const Eigen::Vector3f& color, const Eigen::Vector3d& point) {
        const bool near_box = std::abs(point.x()) < 0.23 && std::abs(point.y()) < 0.18;
        if (point.z() > 1e-3 || near_box) return;
        ++floor;
        if (color[0] > 255 * test::pattern(point)[0] + 30) ++reddish;
      });
  EXPECT_GT(floor, 1000u);
  EXPECT_EQ(reddish, 0u);
}

// The label is that of the pixels themselves: no face gets a colour from them. OpenMVS 2.3 leaves
// out another label.
TEST(TextureMesh, UnusablePixelsAreNotUsed) {
  test::Room room = test::photograph_room(6);
  for (std::size_t v = 0; v < room.images.size(); ++v) {
    auto& [color, usable] = room.images[v];
    usable = cv::Mat1b(color.size(), 255);
    const cv::Rect masked(20 * static_cast<int>(v), 40, 90, 80);
    usable(masked) = 0;
    color(masked).setTo(cv::Scalar(255, 0, 255));
  }
  const TexturedMesh mesh = texture_mesh(test::refined(test::room_mesh(), 4), room.views,
                                         room.source(), test::plain_options());
  EXPECT_LT(summary(test::color_errors(mesh)).median, 2);
  std::size_t magenta = 0;
  test::for_each_color(mesh, [&](std::size_t, const Eigen::Vector3f& c, const Eigen::Vector3d&) {
    if (c[0] > 240 && c[2] > 240) ++magenta;
  });
  EXPECT_EQ(magenta, 0u);
}

// Seen on the upper side of the box, which all views see.
TEST(TextureMesh, AFishInOneViewIsLeftOut) {
  test::Room room = test::photograph_room(8);
  room.images[0].color(cv::Rect(60, 50, 120, 80)).setTo(cv::Scalar(250, 250, 250));
  const auto white = [&](double threshold) {
    Options options = test::plain_options();
    options.outlier_threshold = threshold;
    const TexturedMesh mesh =
        texture_mesh(test::refined(test::room_mesh(), 4), room.views, room.source(), options);
    std::size_t count = 0;
    test::for_each_color(
        mesh, [&](std::size_t, const Eigen::Vector3f& c, const Eigen::Vector3d& p) {
          if (p.z() > 0.999 * test::kBoxHeight && (c - 255 * test::pattern(p)).minCoeff() > 20)
            ++count;
        });
    return count;
  };
  const std::size_t all = white(0);
  EXPECT_GT(all, 20u);
  EXPECT_EQ(white(0.06), 0u);
}

TEST(TextureMesh, TexturesAreTheSameForAnyNumberOfThreads) {
  const test::Room room = test::photograph_room(5, {1, 0.8f, 1.1f, 0.9f, 1});
  const auto run = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    return texture_mesh(test::refined(test::room_mesh(), 4), room.views, room.source());
  };
  const TexturedMesh one = run(1), two = run(2);
  EXPECT_EQ(one.uv, two.uv);
  EXPECT_EQ(one.texture_of, two.texture_of);
  ASSERT_EQ(one.textures.size(), two.textures.size());
  for (std::size_t k = 0; k < one.textures.size(); ++k) {
    ASSERT_EQ(one.textures[k].size(), two.textures[k].size());
    EXPECT_EQ(cv::norm(one.textures[k], two.textures[k], cv::NORM_INF), 0);
  }
}

TEST(TextureMesh, UnseenFacesGetTheEmptyColour) {
  const test::Room room = test::photograph_room(3);
  Mesh mesh = test::room_mesh();
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{0, 0, -1}, {1, 0, -1}, {0, 1, -1}});
  mesh.faces.push_back({first, first + 1, first + 2});
  Options options;
  options.empty_color = {1, 2, 3};
  const TexturedMesh result = texture_mesh(mesh, room.views, room.source(), options);
  const std::uint32_t texture = result.texture_of.back();
  for (const Eigen::Vector2f& uv : result.uv.back())
    EXPECT_EQ(bilinear(result.textures[texture], uv), Eigen::Vector3f(3, 2, 1));
}

// A chart larger than a texture is made smaller; OpenMVS 2.3 aborts.
TEST(TextureMesh, LargeChartsAreScaledDown) {
  const test::Room room = test::photograph_room(4);
  Options options;
  options.packing.max_size = 64;
  Report report;
  const TexturedMesh mesh =
      texture_mesh(test::room_mesh(), room.views, room.source(), options, &report);
  EXPECT_GT(report.scaled_down, 0u);
  EXPECT_GT(mesh.textures.size(), 1u);
  for (const cv::Mat3b& texture : mesh.textures)
    EXPECT_LE(std::max(texture.cols, texture.rows), 64);
  EXPECT_LT(summary(test::color_errors(mesh)).median, 12);  // coarser pixels, but the same places
}

// Each stage checks its memory: a rising limit is refused until it suffices for all stages, and the
// result does not depend on it.
TEST(TextureMesh, ALimitOnMemoryIsKeptOrRefusedInOneLine) {
  const test::Room room = test::photograph_room(4);
  const TexturedMesh free = texture_mesh(test::room_mesh(), room.views, room.source());
  std::set<std::string> works;
  std::optional<TexturedMesh> limited;
  std::uint64_t most = 10'000;
  for (; !limited; most += most / 3) {
    try {
      limited = texture_mesh(test::room_mesh(), room.views, room.source(), {}, nullptr,
                             Context({}, {}, {MemoryBudget::of_bytes(most)}));
      break;
    } catch (const Error& error) {
      const std::string said = error.what();
      EXPECT_THAT(said, testing::MatchesRegex("max_memory: [^\n]+ needs [0-9]+ MB more"
                                              "(; a larger tiles needs less memory)?"));
      works.insert(said.substr(0, 23));
    }
  }
  EXPECT_GT(works.size(), 2u);  // stages
  EXPECT_LT(most, 200'000'000u);
  EXPECT_TRUE(limited->uv == free.uv);
  ASSERT_EQ(limited->textures.size(), free.textures.size());
  for (std::size_t i = 0; i < free.textures.size(); ++i)
    EXPECT_EQ(cv::norm(limited->textures[i], free.textures[i], cv::NORM_INF), 0);
}

// Meshes of other programs: an edge of three faces, a face without area, a face twice.
TEST(TextureMesh, MeshesNeedNotBeManifold) {
  const test::Room room = test::photograph_room(4, {1, 0.8f, 1.1f, 0.9f});
  Mesh mesh = test::refined(test::room_mesh(), 3);
  const std::array<std::uint32_t, 3> face = mesh.faces[0];
  mesh.vertices.push_back({0, 0, 0.1f});
  mesh.faces.push_back({face[0], face[1], static_cast<std::uint32_t>(mesh.vertices.size() - 1)});
  mesh.faces.push_back({face[0], face[0], face[1]});
  mesh.faces.push_back(face);
  const TexturedMesh result = texture_mesh(mesh, room.views, room.source());
  EXPECT_GE(result.mesh.faces.size(), mesh.faces.size());
  EXPECT_LT(summary(test::color_errors(result)).median, 60);
}

TEST(TextureMesh, WrongMeshesAreRefused) {
  const test::Room room = test::photograph_room(2);
  const auto error = [&](const Mesh& mesh) {
    return test::error_of([&] { texture_mesh(mesh, room.views, room.source()); });
  };
  EXPECT_THAT(error({}), HasSubstr("has no faces"));
  Mesh mesh = test::room_mesh();
  mesh.faces[3][1] = 1000;
  EXPECT_THAT(error(mesh), HasSubstr("refers to vertex 1000"));
  mesh = test::room_mesh();
  mesh.vertices[2].x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(error(mesh), HasSubstr("not finite"));
  mesh = test::room_mesh();
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex.z() += 100;
  EXPECT_THAT(error(mesh), HasSubstr("no view sees a face"));
}

// Marked faces get no view, in one piece and in tiles, and stay marked when they are split.
TEST(TextureMesh, MarkedFacesHaveTheEmptyColour) {
  const test::Room room = test::photograph_room(6);
  Mesh marked = test::room_mesh();
  for (std::size_t f = 0; f < marked.faces.size(); ++f) marked.unseen.push_back(f % 3 == 0);
  for (const std::size_t tiles : {std::size_t{1}, std::size_t{2}}) {
    Options options;
    options.tiles = tiles;
    options.empty_color = {1, 250, 3};
    double before = 0, after = 0;
    for (std::size_t f = 0; f < marked.faces.size(); f += 3) before += area(marked, f);
    texture_tiles(
        marked, room.views, room.source(), options, [&](std::size_t, const TexturedMesh& result) {
          const Mesh& mesh = result.mesh;
          ASSERT_EQ(mesh.unseen.size(), mesh.faces.size());
          for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            if (!mesh.unseen[f]) continue;
            after += area(mesh, f);
            const Eigen::Vector2i at = result.uv[f][0].array().round().cast<int>();
            EXPECT_EQ(result.textures[result.texture_of[f]](at.y(), at.x()), cv::Vec3b(3, 250, 1));
          }
        });
    EXPECT_NEAR(after / before, 1, 1e-5) << tiles;
  }
}

}  // namespace
}  // namespace axial::texture
