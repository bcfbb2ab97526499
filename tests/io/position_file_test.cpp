// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/position_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <set>

#include "base/atomic_file.h"
#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::HasSubstr;

// A random name without line ends and without blanks at its ends.
std::string any_name() {
  const auto name = *rc::gen::nonEmpty(
      rc::gen::container<std::string>(rc::gen::element('a', ' ', '#', '"', ',', '7', '\t', '.')));
  RC_PRE(std::string(" \t").find(name.front()) == std::string::npos);
  RC_PRE(std::string(" \t").find(name.back()) == std::string::npos);
  return name;
}

std::string in_quotes(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + '"';
}

PositionFile file_with(const std::string& text, const std::set<std::string>& images = {}) {
  const fs::path folder = test::empty_folder();
  test::put(folder / "positions.txt", text);
  PositionFile read = read_positions(
      folder / "positions.txt", [&](const std::string& name) { return images.contains(name); });
  fs::remove_all(folder);
  return read;
}

std::vector<NamedPosition> positions_in(const std::string& text,
                                        const std::set<std::string>& images = {}) {
  return file_with(text, images).positions;
}

// Names that the model has need no quotes; every name can be quoted.
RC_GTEST_PROP(Positions, KeepAnyName, (double x, double y, double z)) {
  RC_PRE(std::isfinite(x) && std::isfinite(y) && std::isfinite(z));
  const std::string name = any_name();
  const bool known = *rc::gen::arbitrary<bool>();
  const std::string written = known && *rc::gen::arbitrary<bool>() ? name : in_quotes(name);
  const std::string comment = *rc::gen::element<std::string>("", "  ", "\r", " # here", "\t#1");
  const auto read = positions_in(fmt::format("# X\n\n{} {} {}\t{}{}", written, x, y, z, comment),
                                 known ? std::set{name} : std::set<std::string>{});
  RC_ASSERT(read.size() == 1u);
  RC_ASSERT(read[0].name == name);
  RC_ASSERT(read[0].position == Eigen::Vector3d(x, y, z));
  RC_ASSERT(read[0].known == known);
  RC_ASSERT(read[0].line == 3);
}

RC_GTEST_PROP(Lists, KeepAnyName, ()) {
  std::vector<std::string> names;
  std::string list;
  for (int i = *rc::gen::inRange(1, 5); i-- > 0;) {
    names.push_back(any_name());
    const bool plain = names.back().find_first_of(",\"") == std::string::npos;
    list += (list.empty() ? "" : ",") + (plain ? names.back() : in_quotes(names.back()));
  }
  RC_ASSERT(split_list(list, "") == names);
}

TEST(Lists, NameAnOpenQuote) {
  EXPECT_EQ(error_of([] { split_list("a,\"b,c", "--scale-from"); }),
            "--scale-from: a quote is not closed");
  EXPECT_EQ(split_list("", ""), std::vector<std::string>{""});
}

// A '#' belongs to a name only if the model has a name with it.
TEST(Positions, CommentsAreNoNames) {
  const std::string text =
      "# name x y z\n#1.jpg 1 2 3\na.jpg 1 2 3 # 4 5 6\na.jpg 1 2 3 #b 4 5 6\n";
  const auto of = [&](const std::set<std::string>& images) {
    std::vector<std::string> names;
    for (const NamedPosition& position : positions_in(text, images))
      names.push_back(fmt::format("{}={}", position.name, position.position.x()));
    return names;
  };
  EXPECT_EQ(of({"a.jpg"}), (std::vector<std::string>{"a.jpg=1", "a.jpg=1"}));
  EXPECT_EQ(of({}), (std::vector<std::string>{"a.jpg=1", "a.jpg=1"}));
  EXPECT_EQ(of({"#1.jpg", "a.jpg 1 2 3 #b"}),
            (std::vector<std::string>{"#1.jpg=1", "a.jpg=1", "a.jpg 1 2 3 #b=4"}));
}

TEST(Positions, NameTheLineThatIsWrong) {
  for (const char* line :
       {"a.jpg 1 2", "1 2 3", "a.jpg 1 2 x", "a.jpg", "\"a.jpg\"", "a.jpg,1,2", "a.jpg 1 2 # 3"})
    EXPECT_THAT(error_of([&] { positions_in("b 1 2 3\n" + std::string(line) + "\n"); }),
                HasSubstr("positions.txt:2: must be NAME X Y Z"))
        << line;
  EXPECT_THAT(error_of([&] { positions_in("a.jpg 1 inf 3"); }),
              HasSubstr("positions.txt:1: 'inf' is not finite"));
}

// The lines of a file as "name=(x,y,z)".
std::string told(const PositionFile& file) {
  std::string text;
  for (const NamedPosition& one : file.positions)
    text += fmt::format("{}=({},{},{})", one.name, one.position.x(), one.position.y(),
                        one.position.z());
  return text;
}

TEST(Positions, MayBeFieldsBetweenDelimiters) {
  for (const char* text :
       {"a.jpg,1.5,2,-3\n\"b,1\",4,5,6\n", "a.jpg, 1.5, 2, -3\r\n\"b,1\", 4, 5, 6 # here\r\n",
        "a.jpg;1,5;2;-3;\n\"b,1\";4;\"5\";6\n", "sep=;\na.jpg;1,5;2,0;-3\nb,1;4;5;6\n",
        "a.jpg\t1,5\t2\t-3\rb,1\t4\t5\t6\r", "a.jpg\t1.5\t2\t-3\nb,1\t4\t5\t6\n"})
    EXPECT_EQ(told(file_with(text)), "a.jpg=(1.5,2,-3)b,1=(4,5,6)") << text;
  EXPECT_THAT(error_of([] { positions_in("a.jpg,1,5,2,5,3,5\n"); }),
              HasSubstr("positions.txt:1: commas separate the fields and may be decimal marks"));
}

TEST(Positions, HeadersNameTheColumns) {
  const PositionFile metashape = file_with(
      "# CoordinateSystem: PROJCS[\"WGS 84 / UTM zone 33N\"]\n"
      "#Label,X/Easting,Y/Northing,Z/Altitude,Accuracy_X/Y_(m),Accuracy_Z_(m),Yaw,Error_(m),X_est\n"
      "IMG_1,500001,5400002,-3,0.5,1.5,90,0.02,500001.01\n"
      "IMG_2,,,,,,,,\n"
      "IMG_3,500004,5400005,-6,,,,,\n# Total,,,,,,,0.1,\n");
  EXPECT_EQ(told(metashape), "IMG_1=(500001,5400002,-3)IMG_3=(500004,5400005,-6)");
  EXPECT_EQ(metashape.positions[0].sigma, Eigen::Vector3d(0.5, 0.5, 1.5));
  EXPECT_FALSE(metashape.positions[1].sigma);
  EXPECT_THAT(metashape.notes, testing::ElementsAre(HasSubstr("1 lines have no coordinates")));

  EXPECT_EQ(told(file_with("Northing;Easting;Height [m];File Name\n2;1,5;3;a b.jpg\n")),
            "a b.jpg=(1.5,2,3)");
  EXPECT_EQ(told(file_with("# name north east up\na b.jpg 2 1 3\n")), "a b.jpg=(1,2,3)");
  const PositionFile depths = file_with("image,x,y,depth\na,1,2,3\nb,4,5,0.5\n");
  EXPECT_EQ(told(depths), "a=(1,2,-3)b=(4,5,-0.5)");
  EXPECT_THAT(depths.notes, testing::ElementsAre(HasSubstr("depths are positive downwards")));
  EXPECT_EQ(told(file_with("image,x,y,depth\na,1,2,-3\nb,4,5,-0.5\n")), "a=(1,2,-3)b=(4,5,-0.5)");

  EXPECT_THAT(error_of([] { positions_in("label,x (ft),y (ft),z (ft)\na,1,2,3\n"); }),
              HasSubstr("positions.txt:1: column 'x' is in 'ft', but positions must be in metres"));
  EXPECT_THAT(error_of([] { positions_in("label,x,y,z\na,1,,3\n"); }),
              HasSubstr("positions.txt:2: '' is not a number"));
  EXPECT_THAT(error_of([] { positions_in("label,x,y,z\na,1,2,3,4\n"); }),
              HasSubstr("positions.txt:2: has 5 fields, but the header names 4 columns"));
}

// OpenDroneMap's geo.txt and Pix4D's files.
TEST(Positions, NumbersBehindThePositionMayBeAccuracies) {
  const std::set<std::string> images{"a.jpg", "b c.jpg"};
  const PositionFile odm = file_with(
      "WGS84 UTM 33N\na.jpg 500001 5400002 -3 10 0 0 0.5 1.5 any words\nb c.jpg 500004 5400005 "
      "-6\n",
      images);
  EXPECT_EQ(told(odm), "a.jpg=(500001,5400002,-3)b c.jpg=(500004,5400005,-6)");
  EXPECT_EQ(odm.positions[0].sigma, Eigen::Vector3d(0.5, 0.5, 1.5));
  EXPECT_THAT(odm.notes, testing::ElementsAre(HasSubstr("taken as the accuracies")));
  EXPECT_EQ(file_with("a.jpg,1,2,3,0.5,1.5\n").positions.at(0).sigma,
            Eigen::Vector3d(0.5, 0.5, 1.5));
  EXPECT_FALSE(file_with("a.jpg,1.5,2,3,10,20,30\n").positions.at(0).sigma);
  EXPECT_THAT(error_of([] { positions_in("a.jpg,1,2,3,4\n"); }),
              HasSubstr("positions.txt:1: must be NAME X Y Z, but 4 numbers follow the name"));
}

// The places in UTM are those of PROJ 9.1 (proj_trans from EPSG:4326 to EPSG:32633 and EPSG:32701).
TEST(Positions, DegreesBecomeMetres) {
  const PositionFile odm = file_with("EPSG:4326\na.jpg 16.5 54.25 -3\nb.jpg 16.5001 54.2501 -4\n");
  ASSERT_EQ(odm.positions.size(), 2u);
  EXPECT_LT((odm.positions[0].position - Eigen::Vector3d(597730.7113, 6012375.7040, -3)).norm(),
            1e-3)
      << odm.positions[0].position.transpose();
  EXPECT_THAT(odm.notes, testing::ElementsAre(HasSubstr("WGS 84 / UTM zone 33N (EPSG:32633)")));
  // The same by the names of the columns and by Metashape's system; by the fit to the cameras:
  // image_positions_test.cpp.
  for (const char* text :
       {"name,latitude,longitude,altitude\na.jpg,54.25,16.5,-3\nb.jpg,54.2501,16.5001,-4\n",
        "#CoordinateSystem: GEOGCS[\"WGS 84\"]\n#Label,X/Longitude,Y/Latitude,Z/Altitude\n"
        "a.jpg,16.5,54.25,-3\nb.jpg,16.5001,54.2501,-4\n"})
    EXPECT_EQ(file_with(text).positions.at(0).position, odm.positions[0].position) << text;
  const PositionFile south = file_with("EPSG:4326\na.jpg -178.2 -33.5 0\n");
  EXPECT_LT((south.positions[0].position - Eigen::Vector3d(388534.3400, 6292636.4656, 0)).norm(),
            1e-3)
      << south.positions[0].position.transpose();

  EXPECT_THAT(error_of([] {
                positions_in("label,x (deg),y (deg),z\na,54.25,16.5,1\nb,54.2501,16.5001,1\n");
              }),
              HasSubstr("nothing says whether the latitude or the longitude is first"));
  EXPECT_THAT(error_of([] { positions_in("EPSG:4314\na.jpg 16.5 54.25 1\n"); }),
              HasSubstr("the positions are degrees (EPSG:4314); convert the positions"));
  EXPECT_THAT(error_of([] { positions_in("label,x (deg),y (deg),z\na,500000,5400000,1\n"); }),
              HasSubstr("are beyond the longitudes and latitudes of the Earth"));
}

// Numbers that can be metres or degrees are returned as both.
TEST(Positions, MayHaveAnyUnitIfNoLineStatesIt) {
  const auto units_of = [](const std::string& text) {
    std::vector<std::string> units;
    for (const PositionReading& reading : file_with(text, {"a", "b", "c"}).as_degrees)
      units.push_back(reading.unit);
    return units;
  };
  const std::string lonlat = "longitude and latitude in degrees";
  const std::string latlon = "latitude and longitude in degrees";
  using testing::ElementsAre, testing::IsEmpty;
  EXPECT_THAT(units_of("a 54.25 16.5 1\nb 54.29 16.51 1\nc 54.25 16.53 1\n"),
              ElementsAre(lonlat, latlon));
  EXPECT_THAT(units_of("a -154.25 16.5 1\nb -154.2501 16.5 1\nc -154.25 16.5001 1\n"),
              ElementsAre(lonlat));
  EXPECT_THAT(units_of("#Label,X/Longitude,Y/Latitude,Z/Altitude\na,16.5,54.25,-3\n"
                       "b,16.5001,54.2501,-4\nc,16.5,54.2501,-4\n"),
              ElementsAre(lonlat));
  // Labels without an image, and lines of a receiver without a fix, do not count.
  EXPECT_THAT(units_of("a -154.25 16.5 1\nb -154.2501 16.5 1\nx 0 1 0\nc -154.25 16.5001 1\n"),
              ElementsAre(lonlat));
  EXPECT_THAT(units_of("a 54.25 16.5 1\nb 0 0 0\nc 54.25 16.53 1\n"), IsEmpty());
  EXPECT_THAT(units_of("a 88.01 16.5 1\nb 88.02 16.5 1\nc 88.01 16.51 1\n"), ElementsAre(lonlat));
  for (const char* metres :
       {"a 88.01 86.5 1\nb 88.02 86.5 1\nc 88.01 86.51 1\n", "a 1 2 3\nb 1.5 2 3\nc 1 2.5 3\n",
        "a 54.25 16.5 1\nb 54.2501 16.5001 1\n", "a .1 .2 .3\nb .11 .2 .3\nc .1 .21 .3\n",
        "a 2 2 3\nb 2 2 4\nc 2 2 5\n", "a 400 2 3\nb 400.01 2 4\nc 400 2 5\n",
        "#Label,X/Longitude,Y/Latitude,Z\na,400,2,3\nb,400.01,2,4\nc,400,2,5\n",
        "label,x (m),y (m),z (m)\na,2,2,3\nb,2.01,2,4\nc,2,2,5\n",
        "EPSG:32633\na 2 2 3\nb 2.01 2 4\nc 2 2 5\n"})
    EXPECT_THAT(units_of(metres), IsEmpty()) << metres;
  // `positions` are the metres.
  EXPECT_EQ(told(file_with("a 1 2 3\nb 1.5 2 3\nc 1 2.5 3\n")), "a=(1,2,3)b=(1.5,2,3)c=(1,2.5,3)");
  EXPECT_EQ(told(file_with("a 2 2 3\nb 2.01 2 4\nc 2 2 5\n")), "a=(2,2,3)b=(2.01,2,4)c=(2,2,5)");
}

TEST(Positions, NameOtherFiles) {
  EXPECT_THAT(error_of([] { positions_in("1 1 0 0 0 0.1 0.2 0.3 1 a.jpg\n1 2 3\n"); }),
              HasSubstr("positions.txt:1: is a line of COLMAP's images.txt"));
  EXPECT_THAT(error_of([] {
                positions_in(
                    std::string("\xFF\xFE"
                                "a\0 \0",
                                6));
              }),
              HasSubstr("positions.txt: is UTF-16; save it as UTF-8"));
}

}  // namespace
}  // namespace axial::io
