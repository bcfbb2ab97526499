// SPDX-License-Identifier: GPL-3.0-or-later
// Hand-made files of each format, whose pixels and places are known.
#include "control/read_control.h"

#include <cmath>
#include <numbers>

#include "control/control_fixture.h"

namespace axial::control {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using ReadControl = ControlFiles;

// In each format: the target in the middle of the first pixel, and on the lower right corner of the
// pixel in column 1199, row 899.
void expect_known_pixels(const Control& control) {
  ASSERT_EQ(control.images.size(), 2u);
  EXPECT_EQ(control.images[0].pixel, Eigen::Vector2d(0.5, 0.5));
  EXPECT_EQ(control.images[1].pixel, Eigen::Vector2d(1200, 900));
  EXPECT_EQ(control.images[0].label, "target 1");
  EXPECT_EQ(control.images[0].image, "a.jpg");
  EXPECT_EQ(control.images[1].image, "sub/b.jpg");
}

TEST_F(ReadControl, OurTargets) {
  const Control control = read("targets.json", R"({"families": ["circular12"], "images": [],
    "targets": [{"label": "target 1", "image": "a.jpg", "x": 0.5, "y": 0.5, "sigma": 0.01,
                 "dot": [0.08, 0.003, 0.11], "width": 92.1, "agreement": 0.97},
                {"label": "tag 1", "image": "sub/b.jpg", "x": 1200, "y": 900, "sigma": 0.02,
                 "corners": [[1, 2, 0.1], [3, 4, 0.1], [5, 6, 0.1], [7, 8, 0.1]]}]})");
  expect_known_pixels(control);
  EXPECT_EQ(control.images[0].sigma, 0.01);
  EXPECT_EQ(control.images[0].dot, (Eigen::Matrix2d() << 0.08, 0.003, 0.003, 0.11).finished());
  EXPECT_FALSE(control.images[0].corners);
  EXPECT_EQ(control.images[1].corners->at(2), Eigen::Vector2d(5, 6));
  EXPECT_TRUE(control.images[1].dot.isZero(0));
  EXPECT_THAT(control.images[1].where, HasSubstr("targets.json: targets[1]"));
  EXPECT_THAT(control.notes, IsEmpty());
}

TEST_F(ReadControl, OurPointsAndBars) {
  const Control control = read("control.json", R"({"crs": "EPSG:32617",
    "points": [{"label": "target 1", "x": 500000.25, "y": 2500000.5, "z": -3.5, "sigma": 0.02},
               {"label": "target 2", "depth": 4, "sigma": [0, 0, 0.1], "check": true},
               {"label": "target 3", "x": 500001, "y": 2500001}],
    "bars": [{"targets": ["target 1", "target 2"], "length": 0.5, "sigma": 0.001},
             {"targets": ["target 3", "target 4"], "length": 0.502, "check": true}]})");
  EXPECT_EQ(control.crs, "EPSG:32617");
  ASSERT_EQ(control.points.size(), 3u);
  EXPECT_EQ(control.points[0].metres, Eigen::Vector3d(500000.25, 2500000.5, -3.5));
  EXPECT_EQ(control.points[0].sigma, Eigen::Vector3d::Constant(0.02));
  EXPECT_EQ(control.points[1].metres, Eigen::Vector3d(0, 0, -4));
  EXPECT_EQ(control.points[1].sigma, Eigen::Vector3d(kNotKnown, kNotKnown, 0.1));
  EXPECT_TRUE(control.points[1].check);
  EXPECT_EQ(control.points[2].sigma, Eigen::Vector3d(0.01, 0.01, kNotKnown));
  ASSERT_EQ(control.bars.size(), 2u);
  EXPECT_EQ(control.bars[0].sigma, 0.001);
  EXPECT_EQ(control.bars[1].metres, 0.502);
  EXPECT_EQ(control.bars[1].sigma, 0.0005);
  EXPECT_TRUE(control.bars[1].check);
  EXPECT_THAT(control.notes, ElementsAre(HasSubstr("depths are positive"),
                                         HasSubstr("1 points state no accuracy: 0.01 m")));
}

constexpr const char* kGcpList =
    "WGS84 UTM 16N\n"
    "# x y z im_x im_y image name\n"
    "500000.5 2500000.25 -3.5 0.5 0.5 a.jpg target_1\n"
    "500001 2500001 NaN 1200 900 sub/b.jpg\n";

TEST_F(ReadControl, GcpList) {
  const Control control = read("gcp_list.txt", kGcpList);
  ASSERT_EQ(control.images.size(), 2u);
  EXPECT_EQ(control.images[0].pixel, Eigen::Vector2d(0.5, 0.5));
  EXPECT_EQ(control.images[1].pixel, Eigen::Vector2d(1200, 900));
  EXPECT_EQ(control.images[0].label, "target_1");
  EXPECT_EQ(control.images[1].image, "sub/b.jpg");
  EXPECT_EQ(control.crs, "EPSG:32616");
  EXPECT_EQ(point_named(control, "target_1").metres, Eigen::Vector3d(500000.5, 2500000.25, -3.5));
  EXPECT_EQ(point_named(control, "point 1").sigma, Eigen::Vector3d(0.01, 0.01, kNotKnown));
  EXPECT_THAT(control.points[1].where, HasSubstr("gcp_list.txt:4"));
}

TEST_F(ReadControl, GcpListWithoutNames) {
  const Control control = read("gcp_list.txt",
                               "EPSG:32617\n1 2 3 10 20 a.jpg\n1 2 4 10 20 a.jpg\n"
                               "1 2 3 11 21 b.jpg\n5\t6\t7\t1\t2\tc d.jpg\n");
  ASSERT_EQ(control.points.size(), 3u);
  EXPECT_EQ(control.images[2].label, control.images[0].label);
  EXPECT_EQ(control.images[0].label, "point 1");
  EXPECT_EQ(control.images[1].label, "point 2");
  EXPECT_EQ(control.images[3].image, "c d.jpg");
}

constexpr const char* kMarkers = R"x(<?xml version="1.0" encoding="UTF-8"?>
<document version="1.2.0">
  <chunk>
    <cameras>
      <camera id="4" label="a"/>
      <group id="0" label="Group"><camera id="5" label="b.jpg"/></group>
    </cameras>
    <markers>
      <marker id="0" label="target 1"><reference x="1" y="2" z="-3" sx="0.1" sy="0.2" sz="0.3"
        enabled="true"/></marker>
      <marker id="7" label="target 2"><reference x="4" y="5" z="-6" enabled="false"/></marker>
      <marker id="8" label="point 3"/>
    </markers>
    <frames><frame id="0"><markers>
      <marker marker_id="0">
        <location camera_id="4" pinned="true" x="0.5" y="0.5"/>
        <location camera_id="5" pinned="false" x="7" y="8"/>
      </marker>
      <marker marker_id="8"><location camera_id="5" pinned="true" x="1200" y="900"/></marker>
    </markers></frame></frames>
    <scalebars>
      <scalebar id="0" label="b"><endpoint marker_id="0"/><endpoint marker_id="7"/>
        <reference distance="0.5" accuracy="0.002" enabled="true"/></scalebar>
      <scalebar id="1" label="c"><endpoint marker_id="0"/><endpoint marker_id="8"/>
        <reference distance="0.25" accuracy="0" enabled="false"/></scalebar>
      <scalebar id="2" label="d"><endpoint marker_id="0"/><endpoint marker_id="8"/></scalebar>
    </scalebars>
    <coordinate_system>LOCAL_CS["Local Coordinates (m)",UNIT["metre",1]]</coordinate_system>
  </chunk>
</document>
)x";

void expect_markers(const Control& control) {
  ASSERT_EQ(control.images.size(), 2u);
  EXPECT_EQ(control.images[0].pixel, Eigen::Vector2d(0.5, 0.5));
  EXPECT_EQ(control.images[0].image, "a");
  EXPECT_EQ(control.images[1].pixel, Eigen::Vector2d(1200, 900));
  EXPECT_EQ(control.images[1].label, "point 3");
  ASSERT_EQ(control.points.size(), 2u);
  EXPECT_EQ(control.points[0].metres, Eigen::Vector3d(1, 2, -3));
  EXPECT_EQ(control.points[0].sigma, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_FALSE(control.points[0].check);
  EXPECT_TRUE(control.points[1].check);
  ASSERT_EQ(control.bars.size(), 2u);
  EXPECT_EQ(control.bars[0].first, "target 1");
  EXPECT_EQ(control.bars[0].second, "target 2");
  EXPECT_EQ(control.bars[0].sigma, 0.002);
  EXPECT_EQ(control.bars[1].sigma, 0.0005);  // 0 states nothing
  EXPECT_TRUE(control.bars[1].check);
  EXPECT_EQ(control.crs, "");
}

TEST_F(ReadControl, MarkersOfMetashape) {
  const Control control = read("markers.xml", kMarkers);
  expect_markers(control);
  EXPECT_THAT(control.images[1].where, HasSubstr("markers.xml:19"));
}

TEST_F(ReadControl, MarkersWithoutAChunk) {
  std::string text = test::replaced(kMarkers, "<chunk>", "");
  expect_markers(read("markers.xml", test::replaced(text, "</chunk>", "")));
}

TEST_F(ReadControl, ReferenceOfMetashape) {
  const Control control =
      read("reference.csv",
           "# CoordinateSystem: PROJCS[\"WGS 84 / UTM zone 17N\",GEOGCS[\"WGS "
           "84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]]"
           ",PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],"
           "PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\""
           ",0],PARAMETER[\"central_meridian\",-81],PARAMETER[\"scale_factor\","
           "0.9996],PARAMETER[\"false_easting\",500000],PARAMETER[\"false_"
           "northing\",0],UNIT[\"metre\",1],AUTHORITY[\"EPSG\",\"32617\"]]\n"
           "#Label,X/East,Y/North,Z/Altitude,Accuracy_(m),Error_(m),X_error\n"
           "\"target 1\",500000.5,2500000.25,-3.5,0.02,0.5,0.1\n"
           "7,500001,2500001,-4,,,\n"
           "# Total Error,,,,,0.5\n");
  EXPECT_EQ(control.crs, "EPSG:32617");
  ASSERT_EQ(control.points.size(), 2u);
  EXPECT_EQ(control.points[0].metres, Eigen::Vector3d(500000.5, 2500000.25, -3.5));
  EXPECT_EQ(control.points[0].sigma, Eigen::Vector3d::Constant(0.02));
  EXPECT_EQ(control.points[1].label, "target 7");
  EXPECT_EQ(control.points[1].sigma, Eigen::Vector3d::Constant(0.01));
}

// Names of columns that hold either unit.
TEST_F(ReadControl, ColumnsMayBeMetresOrDegrees) {
  const std::string names = "Label,X/Longitude,Y/Latitude,Z/Altitude\n";
  const std::string metres = "a,500000,2500000,-3\n", degrees = "a,-81,24.5,-3\n";
  const std::string system = "# CoordinateSystem: EPSG:32617\n";
  EXPECT_EQ(read("a.csv", system + names + metres).points[0].metres.x(), 500000);
  EXPECT_EQ(read("a.csv", names + degrees).crs, "EPSG:32617");
}

TEST_F(ReadControl, AccuraciesOfSingleCoordinates) {
  const Control control = read("reference.csv",
                               "label;x (m);y (m);z (m);accuracy;Accuracy_X_(m);Accuracy_Z_(m);"
                               "enabled\r\na;1,5;2;3;0,5;0,1;0,3;1\r\nb;;;-2;;;0,2;0\r\n");
  EXPECT_EQ(control.points[0].metres, Eigen::Vector3d(1.5, 2, 3));
  EXPECT_EQ(control.points[0].sigma, Eigen::Vector3d(0.1, 0.5, 0.3));
  EXPECT_EQ(control.points[1].sigma, Eigen::Vector3d(kNotKnown, kNotKnown, 0.2));
  EXPECT_TRUE(control.points[1].check);
}

TEST_F(ReadControl, BarsOfReefShape) {
  const Control control =
      read("bars.txt", "target 1,target 2,0.5,0.01\n3,4,0.499,0,check\ntarget 5,tag 6,0.25\n");
  ASSERT_EQ(control.bars.size(), 3u);
  EXPECT_EQ(control.bars[0].metres, 0.5);
  EXPECT_EQ(control.bars[0].sigma, 0.01);
  EXPECT_EQ(control.bars[1].first, "target 3");
  EXPECT_TRUE(control.bars[1].check);
  EXPECT_EQ(control.bars[1].sigma, 0.0005);
  EXPECT_EQ(control.bars[2].second, "tag 6");
  EXPECT_THAT(control.bars[2].where, HasSubstr("bars.txt:3"));
}

// EPSG:32617 of the places, by `cs2cs EPSG:4326 EPSG:32617` on the meridian of the zone: the
// easting is 500000 there.
constexpr const char* kReefShape =
    "gis_label,gis_lat,gis_lon,Marker Depth (m),xyAcc,zAcc,check\n"
    "1,24.5,-81,-3.5,0.02,0.03,\n2,24.5001,-81,-4.5,0.02,0.03,1\n";

TEST_F(ReadControl, ControlOfReefShape) {
  const Control control = read("control.csv", kReefShape);
  EXPECT_EQ(control.crs, "EPSG:32617");
  ASSERT_EQ(control.points.size(), 2u);
  const ControlPoint& first = control.points[0];
  EXPECT_EQ(first.label, "target 1");
  EXPECT_NEAR(first.metres.x(), 500000, 1e-6);
  EXPECT_EQ(first.metres.z(), -3.5);
  EXPECT_EQ(first.sigma, Eigen::Vector3d(0.02, 0.02, 0.03));
  // 0.0001 degrees of latitude at 24.5 degrees, on the ellipsoid: 11.0767 m, times 0.9996.
  EXPECT_NEAR(control.points[1].metres.y() - first.metres.y(), 11.0723, 0.0005);
  EXPECT_TRUE(control.points[1].check);
  EXPECT_THAT(control.notes,
              ElementsAre(HasSubstr("depths are negative"), HasSubstr("EPSG:32617")));
}

TEST_F(ReadControl, DegreesInAnotherSystem) {
  const Control control = read("control.csv", kReefShape, {.epsg = 32616});
  EXPECT_EQ(control.crs, "EPSG:32616");
  EXPECT_GT(control.points[0].metres.x(), 1'000'000);  // six degrees east of the meridian
}

TEST_F(ReadControl, PositiveDepthsAreBelowTheSurface) {
  const Control control =
      read("control.csv", "label,lon,lat,depth\n1,-81,24.5,3.5\n2,-81,24.5,0\n");
  EXPECT_EQ(control.points[0].metres.z(), -3.5);
  EXPECT_EQ(control.points[1].metres.z(), 0);
}

TEST_F(ReadControl, MetresAreTakenAsTheGivenSystem) {
  const Control control =
      read("control.csv", "label,x,y,z,acc\n1,500000,2500000,-3,0.1\n", {.epsg = 32617});
  EXPECT_EQ(control.crs, "EPSG:32617");
  EXPECT_EQ(control.points[0].metres.x(), 500000);
  EXPECT_THAT(control.notes, ElementsAre(HasSubstr("taken as EPSG:32617")));
}

TEST_F(ReadControl, SameLineTwiceIsOnePoint) {
  EXPECT_EQ(read("control.csv", "label,x,y,z\n1,2,3,4\ntarget 1,2,3,4\n").points.size(), 1u);
  EXPECT_EQ(read("bars.csv", "1,2,0.5,0.01\n2,1,0.5,0.01\n").bars.size(), 1u);
}

TEST_F(ReadControl, HeadersOfBarsStateMetres) {
  for (const char* header : {"a,b,length", "a,b,Length (m)", "a,b,distance_m,accuracy"})
    EXPECT_EQ(read("bars.csv", std::string(header) + "\n1,2,0.5\n").bars.size(), 1u) << header;
}

TEST_F(ReadControl, ACheckOfOneFileStaysACheck) {
  for (const bool first : {true, false}) {
    Control control = read("a.csv", first ? "1,2,0.5,0.01,check\n" : "1,2,0.5,0.01\n");
    append(control, read("b.csv", first ? "1,2,0.5,0.01\n" : "1,2,0.5,0.01,check\n"));
    ASSERT_EQ(control.bars.size(), 1u);
    EXPECT_TRUE(control.bars[0].check);
  }
}

TEST_F(ReadControl, SeveralFilesAreOneControl) {
  Control control = read("a.csv", "label,x,y,z\n1,500000,2500000,-3\n", {.epsg = 32617});
  append(control, read("bars.txt", "1,2,0.5\n"));
  append(control,
         read("b.csv", "label,x,y,z\n1,500000,2500000,-3\n2,500000,2500001,-3\n", {.epsg = 32617}));
  EXPECT_EQ(control.crs, "EPSG:32617");
  EXPECT_EQ(control.points.size(), 2u);
  EXPECT_EQ(control.bars.size(), 1u);
  append(control, read("depths.json", R"({"points": [{"label": "9", "depth": 4}]})"));
  EXPECT_EQ(control.crs, "EPSG:32617");
  EXPECT_THAT(test::error_of([&] { append(control, read("c.csv", "label,x,y,z\n3,1,2,3\n")); }),
              HasSubstr("c.csv:2: the points are in the system ''"));
  EXPECT_THAT(test::error_of([&] { append(control, read("c.txt", "1,2,0.6\n")); }),
              HasSubstr("c.txt:1: target 1-target 2 has other numbers than at"));
}

// Transverse Mercator: 0.9996 on the central meridian, and 1 + (x / R)^2 / 2 times as much at x
// from it, where R is the mean radius of curvature. Spherical Mercator stretches the ellipsoid by
// sqrt(1 - e^2 sin^2) / cos across the meridian and by (1 - e^2 sin^2)^1.5 / ((1 - e^2) cos) along
// it.
TEST_F(ReadControl, TheScaleOfAMapIsThatOfItsProjection) {
  const auto scale = [](const std::string& crs, double x, double y) {
    Control control;
    control.crs = crs;
    for (const double shift : {-1.0, 1.0}) {
      ControlPoint point;
      point.metres = {x + shift, y, 0};
      point.sigma.setConstant(0.01);
      control.points.push_back(point);
    }
    set_map_scale(control);
    return control.map_scale;
  };
  EXPECT_NEAR(scale("EPSG:32617", 500000, 2500000), 0.9996, 1e-7);
  EXPECT_NEAR(scale("EPSG:32717", 700000, 7500000),
              0.9996 * (1 + std::pow(200000 / 0.9996 / 6.363e6, 2) / 2), 2e-6);
  // Fiji, where the step crosses the meridian of 180 degrees.
  EXPECT_NEAR(scale("EPSG:32760", 819778, 8140149),
              0.9996 * (1 + std::pow(319778 / 0.9996 / 6.36e6, 2) / 2), 5e-6);
  EXPECT_NEAR(scale("EPSG:27572", 600000, 2200000), 0.99987742, 1e-7);  // grads; by definition
  const double sine = std::sin(std::numbers::pi / 4), e2 = 0.00669438;
  const double w2 = 1 - e2 * sine * sine;
  // The place of 45 degrees: y = R ln(tan(67.5 degrees)).
  EXPECT_NEAR(scale("EPSG:3857", 0, 6378137 * std::asinh(1)),
              (std::sqrt(w2) + std::pow(w2, 1.5) / (1 - e2)) / 2 / sine, 1e-5);
  EXPECT_EQ(scale("", 5, 7), 1);
  EXPECT_EQ(scale("LOCAL_CS[\"reef\",UNIT[\"metre\",1]]", 5, 7), 1);
  Control heights;
  heights.crs = "EPSG:32617";
  heights.points.emplace_back().sigma = {kNotKnown, kNotKnown, 0.01};
  set_map_scale(heights);
  EXPECT_EQ(heights.map_scale, 1);
}

}  // namespace
}  // namespace axial::control
