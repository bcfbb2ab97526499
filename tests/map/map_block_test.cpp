// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/map_block.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "map/geotiff.h"
#include "support/error_of.h"
#include "worlds/height_field.h"

namespace axial::map {
namespace {

// The colour R G B of the place (x, y): waves of 0.5 m and more.
Eigen::Vector3d color_of(double x, double y) {
  constexpr double k = 2 * std::numbers::pi / 0.5;
  return {127 + 100 * std::sin(k * x), 127 + 100 * std::cos(k * y),
          60 + 40 * std::sin(k * (x + y) / 2)};
}

// A texture over the square from (-1, -1) to (1, 1), seen from above: `size` x `size` texels, whose
// uppermost row is at y = 1.
cv::Mat3b painted_texture(int size) {
  cv::Mat3b texture(size, size);
  for (int v = 0; v < size; ++v)
    for (int u = 0; u < size; ++u) {
      const Eigen::Vector3d c = color_of(-1 + 2 * (u + 0.5) / size, 1 - 2 * (v + 0.5) / size);
      texture(v, u) = {static_cast<std::uint8_t>(c[2] + 0.5), static_cast<std::uint8_t>(c[1] + 0.5),
                       static_cast<std::uint8_t>(c[0] + 0.5)};
    }
  return texture;
}

TexturedMesh textured(Mesh mesh, int size) {
  TexturedMesh result;
  for (const auto& face : mesh.faces) {
    TexturedMesh::Corners& uv = result.uv.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3f& x = mesh.vertices[face[k]];
      const auto s = static_cast<float>(size);
      uv[k] = {(x.x() + 1) / 2 * s - 0.5f, (1 - x.y()) / 2 * s - 0.5f};
    }
  }
  result.texture_of.assign(mesh.faces.size(), 0);
  result.textures = {painted_texture(size)};
  result.mesh = std::move(mesh);
  return result;
}

MapContent content_of(const TexturedMesh& mesh, double pixel) {
  MapContent content{mesh, {}, {}, frame_with_up({0, 0, 1}, {{5e5, 4.5e6, -30}}), {}};
  content.grid = grid_around(mesh.mesh, content.frame, pixel);
  return content;
}

MapBlock whole(const MapContent& content, int samples) {
  const MapGrid& grid = content.grid;
  const FaceBins bins(content.mesh.mesh, content.frame, grid, std::max(grid.columns, grid.rows));
  return make_block(content, bins, 0, samples);
}

Mesh sheet(std::uint32_t cells) {
  return test::height_field({-1, -1}, {1, 1}, cells,
                            [](double x, double y) { return 0.1 * std::sin(3 * x) + 0.2 * y; });
}

// Texels and pixels of about 8 mm: interpolation and the mean over a pixel change a wave of 0.5 m
// by less than a grey level. A displacement by half a pixel would be 5 levels.
TEST(MapBlock, ColorsAreThoseOfTheSurface) {
  const TexturedMesh mesh = textured(sheet(10), 250);
  const MapContent content = content_of(mesh, 1.0 / 128);
  for (const int samples : {1, 3}) {
    const MapBlock block = whole(content, samples);
    ASSERT_EQ(block.colors.size(), cv::Size(256, 256));
    double worst = 0;
    for (int row = 0; row < 256; ++row)
      for (int column = 0; column < 256; ++column) {
        const cv::Vec4b& color = block.colors(row, column);
        ASSERT_EQ(color[3], 255);
        if (row < 2 || column < 2 || row > 253 || column > 253) continue;  // the texture's edge
        const Eigen::Vector3d truth = color_of(-1 + (column + 0.5) / 128, 1 - (row + 0.5) / 128);
        for (int k = 0; k < 3; ++k) worst = std::max(worst, std::abs(color[k] - truth[k]));
      }
    EXPECT_LT(worst, 2) << samples;
  }
}

// Pixels of 8 x 8 texels of a chessboard are grey, and not black or white.
TEST(MapBlock, LargePixelsAreMeansOfTheTexture) {
  TexturedMesh mesh = textured(sheet(4), 256);
  for (int v = 0; v < 256; ++v)
    for (int u = 0; u < 256; ++u)
      mesh.textures[0](v, u) = cv::Vec3b::all((u / 2 + v / 2) % 2 ? 255 : 0);
  const MapContent content = content_of(mesh, 1.0 / 16);
  EXPECT_EQ(samples_per_pixel(content), 9);
  const MapBlock block = whole(content, 9);
  for (const cv::Vec4b& color : block.colors) EXPECT_NEAR(color[0], 127, 25);
}

TEST(MapBlock, TheNumberOfSamplesFollowsFromTheTexture) {
  const TexturedMesh mesh = textured(sheet(4), 256);  // texels of 1/128 m
  EXPECT_EQ(samples_per_pixel(content_of(mesh, 1.0 / 128)), 3);
  EXPECT_EQ(samples_per_pixel(content_of(mesh, 1.0 / 300)), 1);
  EXPECT_EQ(samples_per_pixel(content_of(mesh, 1.0 / 50)), 5);
  EXPECT_EQ(samples_per_pixel(content_of(mesh, 1)), 9);
}

// The height of the pixel's centre, the nodata of holes, and no colour in them.
TEST(MapBlock, HolesHaveNeitherHeightNorColor) {
  Mesh plain = sheet(4);
  plain.faces.erase(plain.faces.begin() + 10, plain.faces.begin() + 12);  // x 0 to 0.5, y -0.5 to 0
  const TexturedMesh mesh = textured(plain, 64);
  std::vector<std::uint16_t> views(mesh.mesh.faces.size(), 3);
  MapContent content = content_of(mesh, 1.0 / 32);
  content.views = views;
  const std::vector<float> errors(mesh.mesh.faces.size(), 0.25f);
  content.errors = errors;
  const MapBlock block = whole(content, 3);
  for (int row = 0; row < 64; ++row)
    for (int column = 0; column < 64; ++column) {
      const bool in_hole = column >= 16 && column < 32 && row >= 32 && row < 48;
      EXPECT_EQ(block.heights(row, column) == kNoHeight, in_hole) << row << " " << column;
      EXPECT_EQ(block.colors(row, column) == cv::Vec4b(0, 0, 0, 0), in_hole);
      EXPECT_EQ(block.counts(row, column), in_hole ? kNoCount : 3);
      EXPECT_EQ(block.errors(row, column), in_hole ? kNoHeight : 0.25f);
      EXPECT_EQ(block.shades(row, column) == 0, in_hole);
    }
}

// A face that TextureMesh has found in no photograph has a height, but no colour.
TEST(MapBlock, FacesWithoutPhotographAreTransparent) {
  TexturedMesh mesh = textured(sheet(4), 64);
  for (const std::size_t face : {10u, 11u}) mesh.uv[face].fill({5, 5});
  std::vector<std::uint16_t> views(mesh.mesh.faces.size(), 2);
  views[10] = views[11] = 0;
  MapContent content = content_of(mesh, 1.0 / 32);
  content.views = views;
  const MapBlock block = whole(content, 3);
  for (int row = 0; row < 64; ++row)
    for (int column = 0; column < 64; ++column) {
      const bool unseen = column >= 16 && column < 32 && row >= 32 && row < 48;
      EXPECT_NE(block.heights(row, column), kNoHeight);
      EXPECT_EQ(block.colors(row, column)[3], unseen ? 0 : 255);
      EXPECT_EQ(block.counts(row, column), unseen ? 0 : 2);
    }
}

// The ground below a table is hidden. The table has another texture.
TEST(MapBlock, HiddenGroundIsNotPainted) {
  TexturedMesh mesh = textured(sheet(4), 64);
  const TexturedMesh table = textured(
      test::height_field({-0.5, -0.25}, {0.5, 0.25}, 2, [](double, double) { return 1.0; }), 64);
  test::append(mesh.mesh, table.mesh);
  mesh.uv.insert(mesh.uv.end(), table.uv.begin(), table.uv.end());
  mesh.texture_of.resize(mesh.mesh.faces.size(), 1);
  mesh.textures.emplace_back(64, 64, cv::Vec3b(1, 2, 255));
  const MapContent content = content_of(mesh, 1.0 / 32);
  const MapBlock block = whole(content, 3);
  int painted = 0;
  for (int row = 0; row < 64; ++row)
    for (int column = 0; column < 64; ++column) {
      const bool is_table = column >= 16 && column < 48 && row >= 24 && row < 40;
      const bool is_red = block.colors(row, column) == cv::Vec4b(255, 2, 1, 255);
      EXPECT_EQ(is_red, is_table);
      EXPECT_EQ(block.heights(row, column) > -29.5, is_table);
      painted += is_red;
    }
  EXPECT_EQ(painted, 32 * 16);
}

TEST(MapBlock, BlocksHaveNoEffect) {
  const TexturedMesh mesh = textured(sheet(9), 128);
  const std::vector<std::uint16_t> views(mesh.mesh.faces.size(), 3);
  MapContent content = content_of(mesh, 0.0171);
  content.views = views;
  const MapBlock all = whole(content, 3);
  const FaceBins bins(content.mesh.mesh, content.frame, content.grid, 32);
  for (std::size_t b = 0; b < bins.blocks(); ++b) {
    const MapBlock block = make_block(content, bins, b, 3);
    ASSERT_FALSE(block.is_empty);
    const auto same = [&](const cv::Mat& one, const cv::Mat& map) {
      return cv::norm(one, map(block.pixels), cv::NORM_INF) == 0;
    };
    EXPECT_TRUE(same(block.heights, all.heights));
    EXPECT_TRUE(same(block.colors, all.colors));
    EXPECT_TRUE(same(block.counts, all.counts));
    EXPECT_TRUE(same(block.shades, all.shades));
  }
}

// n . l of planes whose slopes are known: flat, and turned 45 degrees towards the light and away.
TEST(MapBlock, ShadesAreThoseOfPlanes) {
  const auto shade_of = [](double slope) {
    TexturedMesh mesh;
    mesh.mesh = test::height_field({-1, -1}, {1, 1}, 2, [&](double x, double y) {
      return slope * (x - y) / std::sqrt(2.0);  // rises to the lower right
    });
    return whole(content_of(mesh, 1.0 / 16), 1).shades(8, 9);
  };
  EXPECT_EQ(shade_of(0), static_cast<int>(1.5 + 254 * std::sqrt(0.5)));
  EXPECT_EQ(shade_of(1), 255);
  EXPECT_EQ(shade_of(-1), 1);
}

TEST(MapBlock, WrongContentIsRefused) {
  const auto error = [](const auto& change) {
    TexturedMesh mesh = textured(sheet(2), 16);
    std::vector<std::uint16_t> views(mesh.mesh.faces.size(), 1);
    change(mesh, views);
    MapContent content = content_of(mesh, 0.1);
    content.views = views;
    return test::error_of([&] { check_content(content); });
  };
  using testing::HasSubstr;
  EXPECT_THAT(error([](auto&, auto& views) { views.resize(3); }), HasSubstr("3 numbers of views"));
  EXPECT_THAT(error([](auto& mesh, auto&) { mesh.uv.pop_back(); }), HasSubstr("8 faces have 7"));
  EXPECT_THAT(error([](auto& mesh, auto&) { mesh.texture_of[2] = 1; }),
              HasSubstr("face 2 has no texture 1"));
  EXPECT_THAT(error([](auto& mesh, auto&) { mesh.uv[3][1].x() = std::nanf(""); }),
              HasSubstr("face 3 has a texture coordinate that is not finite"));
}

}  // namespace
}  // namespace axial::map
