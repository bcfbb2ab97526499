// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/areas.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "axial/map.h"
#include "base/atomic_file.h"
#include "map/area_table.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::map {
namespace {

using testing::HasSubstr;

constexpr const char* kUtm = R"("crs": {"type": "name", "properties": {"name": "EPSG:32617"}}, )";

class Areas : public axial::test::FolderTest {
 protected:
  // A file of features, each of properties and a geometry.
  std::filesystem::path write(const std::string& features, const std::string& more = "") const {
    const auto file = folder_ / "areas.geojson";
    write_atomically(
        file, R"({"type": "FeatureCollection", )" + more + R"("features": [)" + features + "]}");
    return file;
  }

  static std::string feature(const std::string& properties, const std::string& coordinates,
                             const std::string& type = "Polygon") {
    return R"({"type": "Feature", "properties": {)" + properties + R"(}, "geometry": {"type": ")" +
           type + R"(", "coordinates": )" + coordinates + "}}";
  }

  std::string error(const std::string& features, const std::string& crs = "") const {
    const auto file = write(features);
    return axial::test::error_of([&] { read_areas(file, crs); });
  }
};

const char* const kSquare = "[[[0,0],[2,0],[2,2],[0,2],[0,0]]]";

TEST_F(Areas, HaveNamesHolesAndParts) {
  const auto areas = read_areas(
      write(feature(R"("id": 7, "Name": "plot A")",
                    "[[[0,0],[4,0],[4,4],[0,4],[0,0]],[[1,1],[2,1],[2,2],[1,1]]]") +
            "," +
            feature(R"("id": 8)", "[[[[0,0],[1,0],[0,1],[0,0]]],[[[5,5],[6,5],[5,6],[5,5]]]]",
                    "MultiPolygon")),
      "");
  ASSERT_EQ(areas.size(), 2U);
  EXPECT_EQ(areas[0].name, "plot A");
  ASSERT_EQ(areas[0].parts.size(), 1U);
  ASSERT_EQ(areas[0].parts[0].size(), 2U);
  EXPECT_EQ(areas[0].parts[0][0].size(), 4U);
  EXPECT_EQ(areas[0].parts[0][0][1], Eigen::Vector2d(4, 0));
  EXPECT_EQ(areas[1].name, "8");  // this feature has no name
  EXPECT_EQ(areas[1].parts.size(), 2U);
}

// 1 degree of longitude at the equator is 111.32 km in UTM, times 0.9996 at the central meridian.
TEST_F(Areas, OfAnotherSystemAreConverted) {
  const std::string crs = crs_of_epsg(32617);
  const auto degrees = read_areas(
      write(feature("", "[[[-81.0001,0],[-80.9999,0],[-81,0.0001],[-81.0001,0]]]")), crs);
  const double width = degrees[0].parts[0][0][1].x() - degrees[0].parts[0][0][0].x();
  EXPECT_NEAR(width, 0.0002 * 111319.49 * 0.9996, 1e-3);
  EXPECT_NEAR(degrees[0].parts[0][0][0].x(), 500000 - width / 2, 1e-3);
  const auto metres = read_areas(
      write(feature("", "[[[500000,10],[500002,10],[500000,12],[500000,10]]]"), kUtm), crs);
  EXPECT_EQ(metres[0].parts[0][0][1], Eigen::Vector2d(500002, 10));
}

TEST_F(Areas, WrongFilesAreErrors) {
  EXPECT_THAT(error(feature("", "[0,0]", "Point")), HasSubstr("areas.geojson: "));
  EXPECT_THAT(error(feature("", kSquare) + "," + feature(R"("name": "p")", "[0,0]", "Point")),
              HasSubstr("feature 'p' is no polygon, but Point"));
  EXPECT_THAT(error(feature(R"("name": "bow")", "[[[0,0],[2,2],[2,0],[0,2],[0,0]]]")),
              HasSubstr("polygon 'bow' crosses itself at (1.000, 1.000)"));
  EXPECT_THAT(error(feature("", "[[[0,0],[2,2],[0,0]]]")), HasSubstr("fewer than three corners"));
  EXPECT_THAT(error(feature(R"("name": "in")",
                            "[[[[0,0],[9,0],[9,9],[0,9],[0,0]]],[[[5,5],[6,5],[5,6],[5,5]]]]",
                            "MultiPolygon")),
              HasSubstr("polygon 'in' has a part in another part"));
  EXPECT_THAT(
      error(R"({"type": "Feature", "properties": {}, "geometry": null},)" + feature("", kSquare)),
      HasSubstr("feature '1' has no geometry"));
  EXPECT_THAT(error(""), HasSubstr("areas.geojson: has no"));
  EXPECT_THAT(
      error(feature("", "[[[500000,10],[500002,10],[500000,12],[500000,10]]]"), crs_of_epsg(32617)),
      HasSubstr("polygon '1' cannot be converted to the coordinates of the map"));
  EXPECT_THAT(axial::test::error_of([&] { read_areas(folder_ / "none.gpkg", ""); }),
              HasSubstr("none.gpkg: cannot be read: it does not exist"));
  write_atomically(folder_ / "text.geojson", "no JSON");
  EXPECT_THAT(axial::test::error_of([&] { read_areas(folder_ / "text.geojson", ""); }),
              HasSubstr("text.geojson: cannot be read: it is no GeoJSON"));
}

// A ring with an island in its hole, and a part beside it.
TEST_F(Areas, OfATableCanBeReadAgain) {
  MeasuredArea one;
  one.area = {"a, \"b\"",
              {{{{0, 0}, {9, 0}, {9, 9}, {0, 9}}, {{1, 1}, {8, 1}, {8, 8}, {1, 8}}},
               {{{3, 3}, {5, 3}, {5, 5}}},
               {{{20, 0}, {22, 0}, {22, 2}}}}};
  one.measures.polygon = 1.875;
  one.measures.planar = 1.5;
  one.measures.surface = one.measures.seen = 3;
  one.measures.plane.level = -20;
  one.smoothed = one.measures;
  const AreaFiles files{folder_ / "t.csv", folder_ / "t.gpkg"};
  const std::string crs = crs_of_epsg(32617);
  write_areas(files, std::vector{one}, 0.01, crs);
  const std::string text = read_file(files.csv), bytes = read_file(files.package);
  EXPECT_THAT(text,
              testing::StartsWith("name,polygon_m2,sigma_polygon_m2,planar_m2,sigma_planar_m2,"
                                  "seen_m2,sigma_seen_m2,surface_m2,"));
  EXPECT_THAT(text, HasSubstr("\n\"a, \"\"b\"\"\",1.875000,0.0375000,1.500000,0.0300000,3.000000,"
                              "0.0600000,3.000000,0.0600000,2.00000,"));
  EXPECT_THAT(text, HasSubstr(",,,,"));  // volumes that are not known
  const auto again = read_areas(files.package, crs);
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(again[0].name, one.area.name);
  EXPECT_EQ(again[0].parts, one.area.parts);
  write_areas(files, std::vector{one}, 0.01, crs);
  EXPECT_EQ(read_file(files.csv), text);
  EXPECT_EQ(read_file(files.package), bytes);
  // Both or none.
  std::filesystem::remove(files.package);
  std::filesystem::create_directory(files.package);
  write_atomically(files.csv, "earlier");
  EXPECT_THAT(axial::test::error_of([&] { write_areas(files, std::vector{one}, 0.01, crs); }),
              HasSubstr("t.gpkg: "));
  EXPECT_EQ(read_file(files.csv), "earlier");
}

}  // namespace
}  // namespace axial::map
