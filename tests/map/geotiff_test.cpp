// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/geotiff.h"

#include <cpl_string.h>
#include <gdal.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "base/atomic_file.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

MapGrid utm_grid() {
  return {500000, 4500000, 0.002, 1300, 700};
}

cv::Mat noise(const MapGrid& grid, int type) {
  cv::Mat pixels(grid.rows, grid.columns, type);
  cv::RNG random(5);
  random.fill(pixels, cv::RNG::UNIFORM, 0, 250);
  return pixels;
}

// Writes the map in blocks of this size.
void write(const fs::path& path, MapKind kind, const cv::Mat& pixels, int block,
           bool backwards = false) {
  const MapGrid grid = utm_grid();
  GeoTiff map(path, kind, grid, crs_of_epsg(32631));
  std::vector<cv::Rect> blocks;
  for (int y = 0; y < grid.rows; y += block)
    for (int x = 0; x < grid.columns; x += block)
      blocks.emplace_back(x, y, std::min(block, grid.columns - x), std::min(block, grid.rows - y));
  if (backwards) std::ranges::reverse(blocks);
  for (const cv::Rect& at : blocks) map.write(at, pixels(at));
  map.finish();
}

TEST(GeoTiff, IsReadAsItWasWritten) {
  const fs::path path = test::empty_folder() / "map.tif";
  for (const auto& [kind, type] :
       {std::pair{MapKind::heights, CV_32FC1}, std::pair{MapKind::colors, CV_8UC4},
        std::pair{MapKind::counts, CV_16UC1}, std::pair{MapKind::shades, CV_8UC1}}) {
    const cv::Mat pixels = noise(utm_grid(), type);
    write(path, kind, pixels, 512);
    const StoredMap map = read_map(path);
    ASSERT_EQ(map.pixels.type(), type);
    ASSERT_EQ(map.pixels.size(), pixels.size());
    EXPECT_EQ(cv::norm(map.pixels, pixels, cv::NORM_INF), 0);
    EXPECT_EQ(map.crs, crs_of_epsg(32631));
  }
}

// The geotransform of GDAL has the corner of the pixel, and not its centre.
TEST(GeoTiff, CornersAreExactInUtm) {
  const fs::path path = test::empty_folder() / "map.tif";
  write(path, MapKind::heights, noise(utm_grid(), CV_32FC1), 512);
  GDALDatasetH file = GDALOpen(path.c_str(), GA_ReadOnly);
  ASSERT_NE(file, nullptr);
  std::array<double, 6> transform{};
  ASSERT_EQ(GDALGetGeoTransform(file, transform.data()), CE_None);
  EXPECT_THAT(transform, testing::ElementsAre(500000, 0.002, 0, 4500000, 0, -0.002));
  const double right = transform[0] + 1300 * transform[1],
               bottom = transform[3] + 700 * transform[5];
  EXPECT_NEAR(right, 500002.6, 1e-6);
  EXPECT_NEAR(bottom, 4499998.6, 1e-6);
  const char* convention = GDALGetMetadataItem(file, "AREA_OR_POINT", nullptr);
  EXPECT_STREQ(convention, "Area");
  EXPECT_THAT(GDALGetProjectionRef(file), HasSubstr("\"EPSG\",\"32631\""));
  EXPECT_STREQ(GDALGetMetadataItem(file, "LAYOUT", "IMAGE_STRUCTURE"), "COG");
  EXPECT_STREQ(GDALGetMetadataItem(file, "COMPRESSION", "IMAGE_STRUCTURE"), "DEFLATE");
  EXPECT_EQ(GDALGetOverviewCount(GDALGetRasterBand(file, 1)), 2);
  int width = 0, height = 0;
  GDALGetBlockSize(GDALGetRasterBand(file, 1), &width, &height);
  EXPECT_EQ(width, 512);
  EXPECT_EQ(height, 512);
  GDALClose(file);
}

TEST(GeoTiff, TheOrderAndTheSizeOfBlocksHaveNoEffect) {
  const fs::path folder = test::empty_folder();
  const cv::Mat pixels = noise(utm_grid(), CV_8UC4);
  write(folder / "a.tif", MapKind::colors, pixels, 512);
  write(folder / "b.tif", MapKind::colors, pixels, 512, true);
  write(folder / "c.tif", MapKind::colors, pixels, 300);
  EXPECT_EQ(read_file(folder / "a.tif"), read_file(folder / "b.tif"));
  EXPECT_EQ(read_file(folder / "a.tif"), read_file(folder / "c.tif"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 3);
}

TEST(GeoTiff, PixelsThatAreNotWrittenHaveNoSurface) {
  const fs::path path = test::empty_folder() / "map.tif";
  const std::pair<MapKind, double> kinds[] = {{MapKind::heights, kNoHeight},
                                              {MapKind::counts, kNoCount}};
  for (const auto& [kind, no_value] : kinds) {
    GeoTiff map(path, kind, utm_grid(), "");
    map.finish();
    const StoredMap stored = read_map(path);
    EXPECT_EQ(stored.no_value, no_value);
    EXPECT_EQ(stored.crs, "");
    cv::Mat1d values = cv::Mat1d(stored.pixels);
    EXPECT_EQ(cv::countNonZero(values != no_value), 0);
  }
  GeoTiff(path, MapKind::colors, utm_grid(), "").finish();
  EXPECT_EQ(cv::norm(read_map(path).pixels, cv::NORM_INF), 0);
}

// Heights next to pixels without surface are not mixed with the number that marks them.
TEST(GeoTiff, ReducedHeightsLeaveOutPixelsWithoutSurface) {
  const fs::path path = test::empty_folder() / "map.tif";
  cv::Mat1f heights(utm_grid().rows, utm_grid().columns, 3.0f);
  for (int y = 0; y < heights.rows; ++y) heights(y, 2 * (y % 600)) = kNoHeight;
  write(path, MapKind::heights, heights, 512);
  const StoredMap reduced = read_map(path, 325);
  EXPECT_EQ(reduced.pixels.cols, 325);
  EXPECT_EQ(reduced.pixels.rows, 175);
  EXPECT_EQ(cv::countNonZero(reduced.pixels != 3.0f), 0);
}

// Pixels of the reduced map are square up to half a pixel of the longer side.
TEST(GeoTiff, ReducedLongMapsAreNotDistorted) {
  const auto size = [](int columns, int rows) {
    return reduced_size({0, 0, 1, columns, rows}, 2048);
  };
  EXPECT_EQ(size(2048, 5), cv::Size(2048, 5));
  EXPECT_EQ(size(4096, 4096), cv::Size(2048, 2048));
  EXPECT_EQ(size(1'000'000, 3), cv::Size(2048, 1));
  for (const int shorter : {20, 33, 47, 700, 9999}) {
    const cv::Size wide = size(10000, shorter);
    EXPECT_EQ(size(shorter, 10000), cv::Size(wide.height, wide.width));
    EXPECT_LE(wide.width, 2048);
    EXPECT_GE(wide.width, 1024);
    EXPECT_NEAR(wide.width, 10000.0 / shorter * wide.height, 0.501);
  }
}

TEST(GeoTiff, ErrorsNameTheFile) {
  const fs::path folder = test::empty_folder();
  EXPECT_THAT(test::error_of([&] { read_map(folder / "none.tif"); }), HasSubstr("none.tif: "));
  write_atomically(folder / "text.tif", "no map");
  EXPECT_THAT(test::error_of([&] { read_map(folder / "text.tif"); }), HasSubstr("text.tif: "));
  EXPECT_THAT(test::error_of(
                  [&] { GeoTiff map(folder / "no" / "map.tif", MapKind::counts, utm_grid(), ""); }),
              HasSubstr("map.tif: "));
}

}  // namespace
}  // namespace axial::map
