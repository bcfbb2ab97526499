// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/map_copies.h"

#include <gdal.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

#include "base/atomic_file.h"
#include "map/geotiff.h"
#include "map/map_archive.h"
#include "map/stated_kind.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(MapCopies, BlocksAreSmallEnoughOverlapAndCoverTheMap) {
  for (const auto& [width, height] : {std::pair{60000, 20000}, std::pair{32767, 32767},
                                      std::pair{32768, 5}, std::pair{7, 1'000'000}}) {
    int right = 0, bottom = 0, last_row = 1, last_column = 0;
    for (const CopyBlock& block : blocks_of({width, height}, kMostOfTagLab, 512)) {
      const cv::Rect& at = block.pixels;
      EXPECT_LE(std::max(at.width, at.height), kMostOfTagLab);
      EXPECT_EQ((at & cv::Rect(0, 0, width, height)), at);
      if (block.row != last_row) right = last_column = 0;
      EXPECT_EQ(block.column, last_column + 1);
      EXPECT_LE(at.x, std::max(0, right - 512));
      EXPECT_LE(at.y, block.row == 1 ? 0 : bottom);
      last_row = block.row, last_column = block.column;
      right = at.br().x, bottom = at.br().y;
    }
    EXPECT_EQ(right, width);
    EXPECT_EQ(bottom, height);
  }
  EXPECT_EQ(blocks_of({60000, 20000}, kMostOfTagLab, 512).size(), 2U);
  EXPECT_EQ(blocks_of({32767, 32767}, kMostOfTagLab, 512).size(), 1U);
}

TEST(MapCopies, OtherWidthsHaveSquarePixels) {
  EXPECT_EQ(size_of_copy({0, 0, 1, 1300, 700}, 650), cv::Size(650, 350));
  EXPECT_EQ(size_of_copy({0, 0, 1, 1300, 700}, 1300), cv::Size(1300, 700));
  EXPECT_EQ(size_of_copy({0, 0, 1, 1300, 700}, 300), cv::Size(300, 162));
  EXPECT_EQ(size_of_copy({0, 0, 1, 1300, 7}, 2), cv::Size(2, 1));
}

// Maps with holes, and their copies.
class Copies : public axial::test::FolderTest {
 protected:
  void SetUp() override {
    axial::test::FolderTest::SetUp();
    cv::RNG random(3);
    heights_.create(grid_.rows, grid_.columns);
    random.fill(heights_, cv::RNG::UNIFORM, 4.0, 6.0);
    colors_.create(grid_.rows, grid_.columns);
    random.fill(colors_, cv::RNG::UNIFORM, 0, 256);
    for (int y = 0; y < grid_.rows; ++y)
      for (int x = 0; x < grid_.columns; ++x) {
        const bool is_open = (x / 31 + y / 17) % 5 == 0;
        if (is_open) heights_(y, x) = kNoHeight;
        colors_(y, x) = is_open ? cv::Vec4b() : colors_(y, x);
        colors_(y, x)[3] = is_open ? 0 : 255;
      }
    write(maps_.heights, MapKind::heights, kinds::kHeights, heights_);
    write(maps_.colors, MapKind::colors, kinds::kColors, colors_);
  }

  void write(const fs::path& path, MapKind kind, const char* stated, const cv::Mat& pixels) const {
    GeoTiff map(path, kind, grid_, crs_of_epsg(32631));
    map.state_kind(stated);
    map.write({0, 0, grid_.columns, grid_.rows}, pixels);
    map.finish();
  }

  // The names of the copies.
  std::vector<std::string> make(const CopyOptions& options) const {
    std::vector<std::string> names;
    for (const FurtherFiles& files : copies_of(maps_, grid_, folder_ / "m", options)) {
      files.write(maps_, files.paths);
      for (const fs::path& path : files.paths) names.push_back(path.filename().string());
    }
    return names;
  }

  // The mean over the area of the pixel (x, y) of a copy, of the pixels with surface.
  double mean_height(int y, int x, double scale) const {
    double sum = 0, weights = 0;
    for (int v = static_cast<int>(y * scale); v < std::min<double>(grid_.rows, (y + 1) * scale);
         ++v)
      for (int u = static_cast<int>(x * scale);
           u < std::min<double>(grid_.columns, (x + 1) * scale); ++u) {
        const double weight =
            (std::min(u + 1.0, (x + 1) * scale) - std::max<double>(u, x * scale)) *
            (std::min(v + 1.0, (y + 1) * scale) - std::max<double>(v, y * scale));
        if (heights_(v, u) == kNoHeight || weight < 1e-9) continue;
        sum += weight * double{heights_(v, u)};
        weights += weight;
      }
    return weights > 0 ? sum / weights : double{kNoHeight};
  }

  MapGrid grid_{500000, 4500000, 0.002, 1300, 700};
  MapFiles maps_{folder_ / "m.dem.tif", folder_ / "m.ortho.tif", {}, {}, {}, {}, {}};
  cv::Mat1f heights_;
  cv::Mat4b colors_;
};

TEST_F(Copies, BlocksOfTagLabHaveThePixelsOfTheMap) {
  const CopyOptions options{Preset::taglab, {}, 800, 100};
  EXPECT_THAT(make(options),
              testing::ElementsAre("m.taglab.ortho_r1_c1.tif", "m.taglab.ortho_r1_c2.tif",
                                   "m.taglab.dem_r1_c1.tif", "m.taglab.dem_r1_c2.tif"));
  const StoredMap colors = read_map(folder_ / "m.taglab.ortho_r1_c2.tif");
  EXPECT_EQ(colors.pixels.cols, 700);
  EXPECT_NEAR(colors.grid.left, 500000 + 600 * 0.002, 1e-9);
  EXPECT_EQ(cv::norm(colors.pixels, colors_(cv::Rect(600, 0, 700, 700)), cv::NORM_INF), 0);
  const StoredMap heights = read_map(folder_ / "m.taglab.dem_r1_c2.tif");
  EXPECT_EQ(heights.no_value, kNoHeight);
  EXPECT_EQ(heights.grid.left, colors.grid.left);
  EXPECT_EQ(cv::norm(heights.pixels, heights_(cv::Rect(600, 0, 700, 700)), cv::NORM_INF), 0);
  const std::unique_ptr<void, decltype(&GDALClose)> file(
      GDALOpen((folder_ / "m.taglab.dem_r1_c2.tif").c_str(), GA_ReadOnly), GDALClose);
  EXPECT_STREQ(GDALGetMetadataItem(file.get(), "COMPRESSION", "IMAGE_STRUCTURE"), "LZW");
  EXPECT_EQ(stated_source(folder_ / "m.taglab.dem_r1_c2.tif"), "m.dem.tif");
}

TEST_F(Copies, OtherWidthsAreMeansByArea) {
  EXPECT_THAT(
      make({Preset::gis, {650, 300}}),
      testing::ElementsAre("m.ortho_650.tif", "m.ortho_300.tif", "m.dem_650.tif", "m.dem_300.tif"));
  for (const int width : {650, 300}) {
    const StoredMap copy = read_map(folder_ / fmt::format("m.dem_{}.tif", width));
    const double scale = 1300.0 / width;
    ASSERT_EQ(copy.pixels.size(), size_of_copy(grid_, width));
    EXPECT_NEAR(copy.grid.pixel, scale * 0.002, 1e-12);
    // GDAL rounds the rows of the map below the last row of the copy, where the map ends: up to
    // half a row of 2.3 counts too much or too little. Elsewhere: single precision of heights of 5
    // m.
    const int whole_rows = static_cast<int>(grid_.rows / scale);
    for (int y = 0; y < copy.pixels.rows; ++y)
      for (int x = 0; x < width; ++x)
        ASSERT_NEAR(copy.pixels.at<float>(y, x), mean_height(y, x, scale),
                    y < whole_rows ? 2e-5 : 0.4)
            << width << ": " << x << " " << y;
  }
}

TEST_F(Copies, ColoursOfOtherWidthsAreMeansOfWhatIsNotTransparent) {
  make({Preset::taglab, {650}});
  const StoredMap copy = read_map(folder_ / "m.taglab.ortho_650.tif");
  for (int y = 0; y < 350; ++y)
    for (int x = 0; x < 650; ++x) {
      cv::Vec4d sum(0, 0, 0, 0);
      double count = 0;
      for (const auto& [v, u] : {std::pair{0, 0}, {0, 1}, {1, 0}, {1, 1}}) {
        const cv::Vec4b& color = colors_(2 * y + v, 2 * x + u);
        if (color[3] == 0) continue;
        sum += cv::Vec4d(color);
        ++count;
      }
      const auto& found = copy.pixels.at<cv::Vec4b>(y, x);
      ASSERT_EQ(found[3] > 0, count > 0);
      for (int k = 0; k < 3 && count > 0; ++k)  // rounded to a level
        ASSERT_NEAR(found[k], sum[k] / count, 0.51);
    }
}

TEST_F(Copies, AnArchiveIsLosslessAndTheSameEachTime) {
  EXPECT_THAT(make({Preset::archive, {}}),
              testing::ElementsAre("m.archive.ortho.tif", "m.archive.ortho.tfw",
                                   "m.archive.dem.tif", "m.archive.dem.tfw"));
  EXPECT_EQ(cv::norm(read_map(folder_ / "m.archive.dem.tif").pixels, heights_, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(read_map(folder_ / "m.archive.ortho.tif").pixels, colors_, cv::NORM_INF), 0);
  EXPECT_EQ(read_file(folder_ / "m.archive.dem.tfw"),
            "0.002\n0\n0\n-0.002\n500000.001\n4499999.999\n");
  const std::string first = read_file(folder_ / "m.archive.ortho.tif");
  make({Preset::archive, {}});
  EXPECT_EQ(read_file(folder_ / "m.archive.ortho.tif"), first);
}

TEST_F(Copies, TheDescriptionOfAnArchive) {
  MapFiles maps = maps_;
  maps.errors = folder_ / "m.sigma.tif";
  cv::Mat1f errors(grid_.rows, grid_.columns, 0.003f);
  errors(cv::Rect(0, 0, grid_.columns / 2, grid_.rows)) = 0.004f;
  write(maps.errors, MapKind::heights, kinds::kErrors, errors);
  write_archive_description(
      maps, {"a < b & \"c\"", "MapSurface 1", {{"flat", 6}}, {{"scene", "folder/scene.mvs"}}, 0.05},
      {"x/m.archive.dem.tif"}, folder_ / "m.xml");
  const std::string text = read_file(folder_ / "m.xml");
  for (const char* part :
       {"<?xml version=\"1.0\" encoding=\"UTF-8\"?>", "<title>a &lt; b &amp; \"c\"</title>",
        "<source role=\"scene\">scene.mvs</source>", "<photographs port=\"flat\">6</photographs>",
        "<spatialResolution unit=\"m\">0.002</spatialResolution>", "<west>500000</west>",
        "<north>4500000</north>", "<mean>0.003500</mean>", "<rms>0.003536</rms>",
        "<largest>0.004000</largest>", "<file>m.archive.dem.tif</file>", "32631"})
    EXPECT_THAT(text, HasSubstr(part));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 4);
}

TEST_F(Copies, WiderThanTheMapIsRefused) {
  EXPECT_THAT(axial::test::error_of([&] {
                require_widths({Preset::gis, {650, 2600}}, grid_);
              }),
              HasSubstr("2600: the map has 1300 columns of 0.002 m"));
  require_widths({Preset::gis, {1300}}, grid_);
}

TEST_F(Copies, ErrorsNameTheFile) {
  const auto copies = copies_of(maps_, grid_, folder_ / "none" / "m", {Preset::taglab, {}});
  EXPECT_THAT(axial::test::error_of([&] { copies[0].write(maps_, copies[0].paths); }),
              HasSubstr("m.taglab.ortho.tif: cannot be written: its folder does not exist"));
}

}  // namespace
}  // namespace axial::map
