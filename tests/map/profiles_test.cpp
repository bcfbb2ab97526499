// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/profiles.h"

#include <gdal.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_api.h>

#include <cmath>
#include <memory>
#include <sstream>

#include "base/atomic_file.h"
#include "base/split.h"
#include "map/contours.h"
#include "map/geotiff.h"
#include "map/stated_kind.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr double kLeft = 500000, kTop = 4500000, kPixel = 0.01;

// A plane: its heights are the same however they are interpolated.
double plane(double x, double y) {
  return 3 + 0.5 * (x - kLeft) - 0.25 * (y - kTop);
}

std::string feature(const std::string& name, const std::string& type,
                    const std::string& coordinates) {
  return R"({"type": "Feature", "properties": {"name": ")" + name +
         R"("}, "geometry": {"type": ")" + type + R"(", "coordinates": )" + coordinates + "}}";
}

// A map of the plane of 3 m x 2 m, with a hole of 0.2 m x 0.2 m in its middle.
class Profiles : public axial::test::FolderTest {
 protected:
  void SetUp() override {
    axial::test::FolderTest::SetUp();
    cv::Mat1f heights(grid_.rows, grid_.columns);
    for (int y = 0; y < grid_.rows; ++y)
      for (int x = 0; x < grid_.columns; ++x) {
        const Eigen::Vector3d at = grid_.centre(y, x, 0);
        heights(y, x) = static_cast<float>(plane(at.x(), at.y()));
      }
    heights(cv::Rect(140, 90, 20, 20)) = kNoHeight;
    GeoTiff map(map_, MapKind::heights, grid_, crs_);
    map.write({0, 0, grid_.columns, grid_.rows}, heights);
    map.finish();
  }

  std::vector<ProfileLine> read(const std::string& features, const std::string& crs) const {
    const auto file = folder_ / "lines.geojson";
    write_atomically(file, R"({"type": "FeatureCollection", "features": [)" + features + "]}");
    return read_lines(file, crs, grid_);
  }

  std::string error(const std::string& features, const std::string& crs = "") const {
    return axial::test::error_of([&] { read(features, crs); });
  }

  // The rows of the table: distance, x, y and height (NaN: unknown).
  std::vector<std::array<double, 4>> rows(const std::vector<ProfileLine>& lines) const {
    write_profiles(map_, lines, files_);
    std::istringstream text(read_file(files_.table));
    std::string line;
    std::getline(text, line);
    EXPECT_EQ(line, "profile,distance_m,x,y,height_m");
    std::vector<std::array<double, 4>> found;
    while (std::getline(text, line)) {
      const auto cells = split(line, ',');
      auto& row = found.emplace_back();
      for (std::size_t k = 0; k < 4; ++k) {
        const std::string cell(cells[cells.size() - 4 + k]);  // a name may have a comma
        row[k] = cell.empty() ? NAN : std::stod(cell);
      }
    }
    return found;
  }

  MapGrid grid_{kLeft, kTop, kPixel, 300, 200};
  std::string crs_ = crs_of_epsg(32631);
  fs::path map_ = folder_ / "m.dem.tif";
  ProfileFiles files_{folder_ / "p.csv", folder_ / "p.gpkg", folder_ / "p.dxf"};
};

TEST_F(Profiles, HaveTheHeightsOfThePlane) {
  const ProfileLine line{
      "a", {{kLeft + 0.1, kTop - 0.1}, {kLeft + 1.1, kTop - 0.1}, {kLeft + 1.1, kTop - 0.605}}};
  const auto found = rows({line});
  // Each centimetre of 1.505 m, and the end.
  ASSERT_EQ(found.size(), 152U);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto [distance, x, y, height] = found[i];
    const double expected = std::min(0.01 * static_cast<double>(i), 1.505);
    EXPECT_NEAR(distance, expected, 1e-4);  // four digits
    EXPECT_NEAR(x, kLeft + 0.1 + std::min(1.0, expected), 1e-4);
    EXPECT_NEAR(height, plane(x, y), 2e-4);
  }
}

TEST_F(Profiles, AreInterruptedAtHoles) {
  const auto found = rows({{"a,b", {{kLeft + 1, kTop - 1}, {kLeft + 2, kTop - 1}}}});
  std::size_t unknown = 0;
  for (const auto& row : found) unknown += std::isnan(row[3]) ? 1 : 0;
  EXPECT_NEAR(static_cast<double>(unknown), 21, 1);  // the hole, and half a pixel at each side
  EXPECT_THAT(read_file(files_.table), HasSubstr("\"a,b\",0.0000,500001.0000,"));
  const std::unique_ptr<void, decltype(&GDALClose)> file(
      GDALOpenEx(files_.package.c_str(), GDAL_OF_VECTOR, nullptr, nullptr, nullptr), GDALClose);
  const OGRLayerH layer = GDALDatasetGetLayer(file.get(), 0);
  const OGRFeatureH feature = OGR_L_GetNextFeature(layer);
  const OGRGeometryH lines = OGR_F_GetGeometryRef(feature);
  ASSERT_EQ(OGR_G_GetGeometryCount(lines), 2);
  const OGRGeometryH first = OGR_G_GetGeometryRef(lines, 0);
  EXPECT_EQ(OGR_G_GetX(first, 0), kLeft + 1);
  EXPECT_NEAR(OGR_G_GetZ(first, 0), plane(kLeft + 1, kTop - 1), 1e-5);
  EXPECT_EQ(OGR_F_GetFieldAsDouble(feature, 1), 1);
  OGR_F_Destroy(feature);
  EXPECT_EQ(stated_kind(files_.package), "map.profiles");
  EXPECT_THAT(read_file(files_.drawing), HasSubstr("profiles"));
}

TEST_F(Profiles, TheSameBytesEachTime) {
  const std::vector<ProfileLine> lines{{"a", {{kLeft + 1, kTop - 1}, {kLeft + 2, kTop - 1.5}}}};
  std::vector<std::string> first;
  for (int i = 0; i < 2; ++i) {
    std::vector<std::string> bytes;
    for (const fs::path& file : {files_.table, files_.package, files_.drawing}) fs::remove(file);
    write_profiles(map_, lines, files_);
    write_contours(map_, 0.1, {folder_ / "c.geojson", folder_ / "c.gpkg", folder_ / "c.dxf"});
    for (const fs::path& file :
         {files_.table, files_.package, files_.drawing, folder_ / "c.gpkg", folder_ / "c.dxf"})
      bytes.push_back(read_file(file));
    if (i == 0) first = bytes;
    EXPECT_EQ(bytes, first);
    fs::remove(folder_ / "c.gpkg");
  }
}

// Heights of the levels, and the lengths of the lines [m].
std::vector<std::pair<double, double>> lines_in(const fs::path& path) {
  const std::unique_ptr<void, decltype(&GDALClose)> file(
      GDALOpenEx(path.c_str(), GDAL_OF_VECTOR, nullptr, nullptr, nullptr), GDALClose);
  std::vector<std::pair<double, double>> lines;
  const OGRLayerH layer = GDALDatasetGetLayer(file.get(), 0);
  while (const OGRFeatureH feature = OGR_L_GetNextFeature(layer)) {
    const OGRGeometryH line = OGR_F_GetGeometryRef(feature);
    const double level = OGR_G_GetZ(line, 0);
    for (int k = 0; k < OGR_G_GetPointCount(line); ++k) {
      EXPECT_EQ(OGR_G_GetZ(line, k), level);
      // Lines go on for half a pixel beyond the last centre, at the height of the centre.
      EXPECT_NEAR(plane(OGR_G_GetX(line, k), OGR_G_GetY(line, k)), level,
                  1e-4 + kPixel / 2 * (0.5 + 0.25));
    }
    lines.emplace_back(level, OGR_G_Length(line));
    OGR_F_Destroy(feature);
  }
  return lines;
}

// The drawing, as GDAL reads it, has the lines of the GeoPackage with the heights of their levels.
TEST_F(Profiles, ContoursAreTheSameInAllFormats) {
  write_contours(map_, 0.1, {folder_ / "c.geojson", folder_ / "c.gpkg", folder_ / "c.dxf"});
  const auto lines = lines_in(folder_ / "c.gpkg"), drawn = lines_in(folder_ / "c.dxf");
  ASSERT_GT(lines.size(), 15U);  // heights from 3 m to 5 m
  ASSERT_EQ(drawn.size(), lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_NEAR(drawn[i].first, lines[i].first, 1e-9);  // a DXF has 15 digits
    EXPECT_NEAR(drawn[i].second, lines[i].second, 1e-6);
  }
  EXPECT_EQ(stated_kind(folder_ / "c.gpkg"), "map.contours");
}

TEST_F(Profiles, ReadLinesAndTheirParts) {
  const auto lines =
      read(feature("a", "LineString", "[[500000.5,4499999],[500001,4499999]]") + "," +
               feature("b", "MultiLineString",
                       "[[[500000,4500000],[500003,4499998]],"
                       "[[500001,4499999],[500002,4499999]]]"),
           "");
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0].name, "a");
  EXPECT_EQ(lines[1].name, "b 1");
  EXPECT_EQ(lines[2].name, "b 2");
  EXPECT_EQ(lines[1].corners[1], Eigen::Vector2d(500003, 4499998));
}

// The centre of the map, in degrees: 3 degrees east is x = 500,000 m of the zone 31.
TEST_F(Profiles, AreConvertedToTheSystemOfTheMap) {
  const auto lines =
      read(feature("a", "LineString", "[[3.000006,40.650851],[3.000030,40.650851]]"), crs_);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NEAR(lines[0].corners[0].x(), 500000 + 0.5, 0.05);
}

TEST_F(Profiles, ErrorsNameTheLine) {
  const std::string inside = "[[500000.5,4499999],[500001,4499999]]";
  EXPECT_THAT(error(feature("a", "LineString", "[[500000.5,4499999],[500004,4499999]]")),
              HasSubstr("lines.geojson: line 'a' is not on the map at (500004.000, 4499999.000): "
                        "the map has x from 500000.000 to 500003.000"));
  EXPECT_THAT(error(feature("a", "LineString", inside), crs_),
              HasSubstr("'a' cannot be converted"));
  EXPECT_THAT(error(feature("a", "Point", "[500000.5,4499999]")),
              HasSubstr("has no layer with lines"));
  EXPECT_THAT(error(feature("a", "LineString", "[[500001,4499999],[500001,4499999]]")),
              HasSubstr("line 'a' has no length"));
  EXPECT_THAT(
      error(feature("a", "LineString", inside) + "," + feature("b", "Point", "[500000.5,4499999]")),
      HasSubstr("feature 'b' is no line, but Point"));
  EXPECT_THAT(error(""), HasSubstr("lines"));
}

}  // namespace
}  // namespace axial::map
