// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/label_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "axial/map.h"
#include "base/atomic_file.h"
#include "support/empty_folder.h"
#include "support/error_of.h"

namespace axial::map {
namespace {

using testing::HasSubstr;

class LabelFile : public axial::test::FolderTest {
 protected:
  std::filesystem::path write(const std::string& features) const {
    const auto file = folder_ / "labels.geojson";
    write_atomically(file, R"({"type": "FeatureCollection", "features": [)" + features + "]}");
    return file;
  }

  static std::string feature(const std::string& properties, const std::string& type,
                             const std::string& coordinates) {
    return R"({"type": "Feature", "properties": {)" + properties + R"(}, "geometry": {"type": ")" +
           type + R"(", "coordinates": )" + coordinates + "}}";
  }

  std::string error(const std::string& features, const std::string& field = "") const {
    const auto file = write(features);
    return axial::test::error_of([&] { read_labels(file, "", field); });
  }
};

const char* const kTwoByTwo = "[[[0,0],[2,0],[2,2],[0,2],[0,0]]]";

TEST_F(LabelFile, HasPolygonsPointsAndClasses) {
  const auto file = write(
      feature(R"("name": "p1", "Class": "coral", "taxon": "Acropora")", "Polygon", kTwoByTwo) +
      "," + feature(R"("Species": "alga", "label": "l")", "Point", "[3, 4, 5]") + "," +
      feature("", "MultiPoint", "[[1, 2], [3, 4]]"));
  const auto labels = read_labels(file, "", "");
  ASSERT_EQ(labels.size(), 3U);
  EXPECT_EQ(labels[0].name, "p1");
  EXPECT_EQ(labels[0].category, "coral");
  ASSERT_EQ(labels[0].parts.size(), 1U);
  EXPECT_TRUE(labels[0].points.empty());
  EXPECT_EQ(labels[1].name, "l");
  EXPECT_EQ(labels[1].category, "alga");
  EXPECT_EQ(labels[1].points, (std::vector<Eigen::Vector2d>{{3, 4}}));
  EXPECT_EQ(labels[2].name, "3");
  EXPECT_EQ(labels[2].category, "label");
  EXPECT_EQ(labels[2].points, (std::vector<Eigen::Vector2d>{{1, 2}, {3, 4}}));
  const auto chosen = read_labels(file, "", "taxon");
  EXPECT_EQ(chosen[0].category, "Acropora");
  EXPECT_EQ(chosen[1].category, "label");
}

TEST_F(LabelFile, WrongFilesAreErrors) {
  EXPECT_THAT(error(feature("", "LineString", "[[0, 0], [1, 1]]")),
              HasSubstr("labels.geojson: has no layer with polygons or points"));
  EXPECT_THAT(error(feature("", "Point", "[0, 0]") + "," +
                    feature(R"("name": "way")", "LineString", "[[0, 0], [1, 1]]")),
              HasSubstr("feature 'way' is neither polygon nor point, but "));
  EXPECT_THAT(error(feature("", "Point", "[0, 0]"), "taxon"), HasSubstr("has no field 'taxon'"));
  EXPECT_THAT(error(feature("", "MultiPoint", "[]")), HasSubstr("point '1' is empty"));
  EXPECT_THAT(error(feature(R"("name": "bow")", "Polygon", "[[[0,0],[2,2],[2,0],[0,2],[0,0]]]")),
              HasSubstr("polygon 'bow' crosses itself"));
}

TEST_F(LabelFile, IsReadAsItWasWritten) {
  const std::string crs = crs_of_epsg(32617);
  LabelFromPhotograph one{"left/a.jpg", {"p \"1\"", "coral", {}, {}}, {}};
  one.label.parts = {{{{500000, 9}, {500009, 9}, {500009, 18}, {500000, 18}},
                      {{500001, 10}, {500001, 12}, {500003, 12}}},
                     {{{500020, 0}, {500022, 0}, {500022, 2}}}};
  one.label.points = {{500001, 2}};
  for (int i = 0; i < 11; ++i) one.heights.push_back(-20 - i);
  one.heights[1] = std::numeric_limits<double>::quiet_NaN();
  const LabelFiles files{folder_ / "l.geojson", folder_ / "l.gpkg"};
  write_labels(files, std::vector{one, LabelFromPhotograph{}}, crs);
  const std::string text = read_file(files.geojson), bytes = read_file(files.package);
  const auto json = nlohmann::json::parse(text);
  ASSERT_EQ(json["features"].size(), 2U);  // an empty label is left out
  EXPECT_EQ(json["features"][0]["properties"]["photograph"], "left/a.jpg");
  EXPECT_EQ(json["features"][0]["geometry"]["coordinates"][0][0][0][2], -20);
  // Without a height, the corner (500009, 9) gets that of the nearest corner with one, (500003,
  // 12).
  EXPECT_EQ(json["features"][0]["geometry"]["coordinates"][0][0][1][2], -26);
  EXPECT_EQ(json["features"][1]["geometry"]["coordinates"][0],
            (std::vector<double>{500001, 2, -30}));
  const auto again = read_labels(files.geojson, crs, "");
  ASSERT_EQ(again.size(), 2U);
  EXPECT_EQ(again[0].name, one.label.name);
  EXPECT_EQ(again[0].category, "coral");
  EXPECT_EQ(again[0].parts, one.label.parts);
  EXPECT_EQ(again[1].points, one.label.points);
  const auto packed = read_labels(files.package, crs, "");  // the layers one after the other
  ASSERT_EQ(packed.size(), 2U);
  EXPECT_EQ(packed[0].name, one.label.name);
  EXPECT_EQ(packed[0].category, "coral");
  EXPECT_EQ(packed[0].parts, one.label.parts);
  EXPECT_EQ(packed[1].name, one.label.name);
  EXPECT_EQ(packed[1].points, one.label.points);
  write_labels(files, std::vector{one, LabelFromPhotograph{}}, crs);
  EXPECT_EQ(read_file(files.geojson), text);
  EXPECT_EQ(read_file(files.package), bytes);
}

// A polygon layer without features is no layer for MeasureSurface either.
TEST_F(LabelFile, HasNoLayersWithoutFeatures) {
  LabelFromPhotograph one{"a.jpg", {"p", "coral", {}, {{1, 2}}}, {-3}};
  const LabelFiles files{folder_ / "l.geojson", folder_ / "l.gpkg"};
  write_labels(files, std::vector{one}, "");
  ASSERT_EQ(read_labels(files.package, "", "").size(), 1U);
  EXPECT_THAT(axial::test::error_of([&] { read_areas(files.package, ""); }),
              HasSubstr("has no layer with polygons"));
  one.label = {"p", "coral", {{{{0, 0}, {2, 0}, {2, 2}}}}, {}};
  one.heights = {-3, -3, -3};
  write_labels(files, std::vector{one}, "");
  EXPECT_EQ(read_areas(files.package, "").size(), 1U);
}

}  // namespace
}  // namespace axial::map
