// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/reduced_map.h"

#include <gdal.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/atomic_file.h"
#include "base/program/out_of_memory.h"
#include "map/stated_kind.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::EndsWith;
using testing::HasSubstr;

const MapGrid kUtmGrid{500000.125, 4500000.5, 0.01, 1024, 512};

WorldAxes tilted() {
  WorldAxes axes;
  axes.axes = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  axes.offset = {0, 0, -4500123.456789};
  return axes;
}

void write(const fs::path& path, MapKind kind, const cv::Mat& pixels,
           const std::optional<WorldAxes>& axes = {}) {
  GeoTiff map(path, kind, kUtmGrid, "");
  if (axes) map.state_axes(*axes);
  map.write({{}, pixels.size()}, pixels);
  map.finish();
}

// Heights 3 + x / 100 (x in pixels) but for the middle third, which has none.
cv::Mat1f ramp() {
  cv::Mat1f heights(kUtmGrid.rows, kUtmGrid.columns);
  for (int y = 0; y < heights.rows; ++y)
    for (int x = 0; x < heights.cols; ++x)
      heights(y, x) = x / 256 == 1 ? kNoHeight : 3 + (static_cast<float>(x) + 0.5F) / 100;
  return heights;
}

TEST(ReducedMap, AveragesHeightsAndLeavesMissingOnesOut) {
  const fs::path path = test::empty_folder() / "map.tif";
  write(path, MapKind::heights, ramp());
  for (const int longest : {1024, 500, 128, 60}) {
    const ReducedMap map = read_reduced_map(path, MapKind::heights, longest);
    const cv::Mat1f pixels = map.pixels;
    ASSERT_EQ(pixels.cols, longest);
    ASSERT_EQ(pixels.rows, longest / 2);
    EXPECT_EQ(map.grid.left, kUtmGrid.left);
    EXPECT_EQ(map.grid.columns, kUtmGrid.columns);
    const double width = 1024.0 / longest;
    EXPECT_NEAR(map.pixel_width(), 0.01 * width, 1e-12);
    for (int x = 0; x < longest; ++x) {
      const double left = x * width, right = left + width;
      const float value = pixels(longest / 4, x);
      if (left >= 256 + width && right <= 512 - width) {
        EXPECT_TRUE(std::isnan(value)) << longest << " " << x;
      } else if (right <= 256 - width || left >= 512 + width) {
        EXPECT_NEAR(value, 3 + (left + right) / 200, 0.012 * width) << longest << " " << x;
      } else if (!std::isnan(value)) {
        EXPECT_TRUE(value > 3 && value < 14) << value;  // no -9999 in a mean
      }
    }
  }
}

TEST(ReducedMap, LeavesInfiniteHeightsOut) {
  const fs::path path = test::empty_folder() / "map.tif";
  cv::Mat1f heights = ramp();
  heights(7, 5) = std::numeric_limits<float>::infinity();
  heights(7, 6) = -std::numeric_limits<float>::infinity();
  write(path, MapKind::heights, heights);
  const cv::Mat1f pixels = read_reduced_map(path, MapKind::heights, 1024).pixels;
  EXPECT_TRUE(std::isnan(pixels(7, 5)) && std::isnan(pixels(7, 6)));
  EXPECT_EQ(pixels(7, 7), heights(7, 7));
}

TEST(ReducedMap, ReadsCountsColoursAndClasses) {
  const fs::path folder = test::empty_folder();
  cv::Mat1w counts(kUtmGrid.rows, kUtmGrid.columns, std::uint16_t{7});
  counts(cv::Rect(0, 0, 512, 512)) = kNoCount;
  write(folder / "counts.tif", MapKind::counts, counts);
  const cv::Mat1f read = read_reduced_map(folder / "counts.tif", MapKind::counts, 64).pixels;
  EXPECT_TRUE(std::isnan(read(10, 5)));
  EXPECT_EQ(read(10, 60), 7);

  cv::Mat4b colors(kUtmGrid.rows, kUtmGrid.columns, cv::Vec4b(0, 0, 0, 0));
  for (int x = 512; x < 1024; ++x) colors.col(x) = cv::Vec4b(200, 100, 50, 255);
  write(folder / "colors.tif", MapKind::colors, colors);
  const cv::Mat4b seen = read_reduced_map(folder / "colors.tif", MapKind::colors, 64).pixels;
  EXPECT_EQ(seen(10, 5)[3], 0);
  EXPECT_EQ(seen(10, 60), cv::Vec4b(200, 100, 50, 255));

  cv::Mat1b classes(kUtmGrid.rows, kUtmGrid.columns, std::uint8_t{2});
  classes(cv::Rect(0, 0, 512, 512)) = 0;
  classes(cv::Rect(0, 0, 100, 512)) = kNoClass;
  write(folder / "classes.tif", MapKind::classes, classes);
  const cv::Mat1f kinds = read_reduced_map(folder / "classes.tif", MapKind::classes, 64).pixels;
  EXPECT_TRUE(std::isnan(kinds(10, 2)));
  EXPECT_EQ(kinds(10, 20), 0);
  EXPECT_EQ(kinds(10, 60), 2);
}

// A point at UTM coordinates keeps its millimetres on its way to the map, to the file and back.
TEST(ReducedMap, AxesLeadBackToTheWorld) {
  const fs::path path = test::empty_folder() / "map.tif";
  const LocalFrame frame{{500000, 4500000, -20}};
  const MapFrame on_map = frame_with_up({0.3, -0.2, 1}, frame);
  write(path, MapKind::heights, ramp(), world_axes(on_map, frame));
  const ReducedMap map = read_reduced_map(path, MapKind::heights, 64);
  ASSERT_TRUE(map.axes);
  const Eigen::Vector3d local(1.2345, -6.7891, 0.4321);
  const Eigen::Vector3d found = map.axes->to_world(on_map.to_map(local)) - frame.origin;
  EXPECT_LT((found - local).norm(), 1e-6);
}

TEST(ReducedMap, FilesWithoutAxesHaveNone) {
  const fs::path path = test::empty_folder() / "map.tif";
  write(path, MapKind::heights, ramp());
  EXPECT_FALSE(read_reduced_map(path, MapKind::heights, 64).axes);
  write(path, MapKind::heights, ramp(), tilted());
  const auto axes = read_reduced_map(path, MapKind::heights, 64).axes;
  ASSERT_TRUE(axes);
  EXPECT_EQ(axes->axes, tilted().axes);
  EXPECT_EQ(axes->offset, tilted().offset);
}

void edit(const fs::path& path, const std::function<void(GDALDatasetH)>& change) {
  GDALDatasetH file = GDALOpen(path.c_str(), GA_Update);
  ASSERT_NE(file, nullptr);
  change(file);
  GDALClose(file);
}

TEST(ReducedMap, RefusesOtherKinds) {
  const fs::path path = test::empty_folder() / "map.tif";
  const auto error = [&] {
    return test::error_of([&] { read_reduced_map(path, MapKind::heights, 64, kinds::kErrors); });
  };
  write(path, MapKind::heights, ramp());
  EXPECT_THAT(error(), HasSubstr("map.tif: AXIALMVS_KIND is missing: must be map.sigma, as "
                                 "MapSurface writes it"));
  EXPECT_EQ(stated_kind(path), "");
  edit(path, [](GDALDatasetH file) {
    GDALSetMetadataItem(file, "AXIALMVS_KIND", kinds::kSigma, nullptr);
  });
  EXPECT_EQ(stated_kind(path), "change.sigma");
  EXPECT_THAT(error(), HasSubstr("map.tif: AXIALMVS_KIND change.sigma: must be map.sigma"));
  EXPECT_NO_THROW(read_reduced_map(path, MapKind::heights, 64, kinds::kSigma));
  EXPECT_EQ(stated_kind(path.parent_path() / "none.tif"), "");
}

// GDAL's and libtiff's words would name temporary files and functions.
TEST(ReducedMap, DamagedFilesAreNamedInOurWords) {
  const fs::path path = test::empty_folder() / "map.tif";
  write(path, MapKind::heights, ramp());
  const std::string whole = read_file(path);
  const auto error = [&] {
    return test::error_of([&] { read_reduced_map(path, MapKind::heights, 1 << 14); });
  };
  fs::remove(path);
  EXPECT_THAT(error(), EndsWith("map.tif: cannot be read: it does not exist"));
  write_atomically(path, whole.substr(0, 300));
  EXPECT_THAT(error(), EndsWith("map.tif: cannot be read: it is no GeoTIFF, or it is damaged"));
  for (const int tag : {322, 323}) {  // sizes of the tiles
    std::string damaged = whole;
    const std::string entry{
        static_cast<char>(tag & 255), static_cast<char>(tag >> 8), 3, 0, 1, 0, 0, 0};
    const std::size_t at = whole.find(entry);
    ASSERT_NE(at, std::string::npos) << tag;
    damaged[at + 2] = 4;  // a number of 32 bits
    damaged.replace(at + 8, 4, std::string("\xF0\xFF\xFF\x7F", 4));
    write_atomically(path, damaged);
    const std::string said = error();
    EXPECT_THAT(said, HasSubstr("map.tif: ")) << tag;
    EXPECT_THAT(said, AnyOf(HasSubstr("damaged"), HasSubstr("geotransform"))) << tag;
    EXPECT_FALSE(is_out_of_memory(Error(said))) << tag;
  }
}

TEST(ReducedMap, RefusesForeignFiles) {
  const fs::path path = test::empty_folder() / "map.tif";
  const auto error = [&](MapKind kind) {
    return test::error_of([&] { read_reduced_map(path, kind, 64); });
  };
  EXPECT_THAT(error(MapKind::heights), HasSubstr("map.tif: "));
  write(path, MapKind::heights, ramp(), tilted());
  EXPECT_THAT(error(MapKind::colors), HasSubstr("map.tif: has 1 band of Float32, but a map of "
                                                "colours has 4 bands of Byte"));
  CPLPushErrorHandler(CPLQuietErrorHandler);
  edit(path,
       [](GDALDatasetH file) { GDALSetMetadataItem(file, "AXIALMVS_OFFSET", "1 2 x", nullptr); });
  EXPECT_THAT(error(MapKind::heights),
              HasSubstr("map.tif: AXIALMVS_OFFSET 1 2 x: must be 3 numbers"));
  edit(path, [](GDALDatasetH file) {
    GDALSetMetadataItem(file, "AXIALMVS_OFFSET", "1 2 3", nullptr);
    GDALSetMetadataItem(file, "AXIALMVS_AXES", "1 0 0 0 1 0 0 0 2", nullptr);
  });
  EXPECT_THAT(error(MapKind::heights), HasSubstr("map.tif: AXIALMVS_AXES: is no rotation"));
  edit(path, [](GDALDatasetH file) {
    std::array<double, 6> turned{0, 0.01, 0.001, 0, 0.001, -0.01};
    GDALSetGeoTransform(file, turned.data());
  });
  EXPECT_THAT(error(MapKind::heights), HasSubstr("map.tif: has no geotransform of a map"));
  CPLPopErrorHandler();
}

}  // namespace
}  // namespace axial::map
