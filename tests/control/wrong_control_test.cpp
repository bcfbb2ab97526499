// SPDX-License-Identifier: GPL-3.0-or-later
// Wrong files: one line that names the file, the place and the label.
#include <vector>

#include "control/control_fixture.h"

namespace axial::control {
namespace {

using testing::HasSubstr;

struct Wrong {
  const char* name;
  const char* text;
  const char* place;   // behind the name of the file
  const char* expect;  // in the message
  ControlReading options = {};
};

const std::vector<Wrong> kWrong{
    {"a.csv", "", "", "is empty"},
    {"a.csv", "label,x,z\n1,2,3\n", ":1", "no column y"},
    {"a.csv", "label,x,y\n1,2,3\n", ":1", "no column z"},
    {"a.csv", "label,x (ft),y,z\n1,2,3,4\n", ":1", "'ft'"},
    {"a.csv", "label,x,y,z\n1,2,a,4\n", ":2: target 1", "'a' is not a number"},
    {"a.csv", "label,x,y,z\n1,2,inf,4\n", ":2: target 1", "not finite"},
    {"a.csv", "label,x,y,z\n1,2,,4\n", ":2: target 1", "only one of the two"},
    {"a.csv", "label,x,y,z,acc\n1,2,3,4,-1\n", ":2: target 1", "must be above 0"},
    {"a.csv", "label,x,y,z\n1,2,3,4,5\n", ":2", "5 fields"},
    {"a.csv", "label,x,y,z\n,2,3,4\n", ":2", "label is empty"},
    {"a.csv", "label,x,y,z\n\"1,2,3,4\n", ":2", "quote"},
    {"a.csv", "label,x,y,z,check\n1,2,3,4,maybe\n", ":2: target 1", "'maybe'"},
    {"a.csv", "label,x,y,z\n1,2,3,4\nTarget 1,2,3,5\n", ":3: Target 1", "another place"},
    {"a.csv", "label,x,y,depth\n1,2,3,4\n2,2,3,-4\n", ":2: target 1", "one sign"},
    {"a.csv", "label,lat,lon,z\n1,95,3,4\n", ":2: target 1", "not on the Earth"},
    {"a.csv", "label,lat,lon,z\n1,5,3,4\n", "", "EPSG:4326", {.epsg = 4326}},
    {"a.csv", "label,x,y,z\n1,5,3,4\n", "", "EPSG:99", {.epsg = 99}},
    {"a.csv", "1,2,x\n", ":1", "TARGET,TARGET,LENGTH"},
    {"a.csv", "1,2,0.5\n3,4\n", ":2", "TARGET,TARGET,LENGTH"},
    {"a.csv", "a,b,length (mm)\n1,2,500\n", ":1", "'length (mm)' must be in metres"},
    {"a.csv", "a,b,Length_ft\n1,2,5\n", ":1", "'Length_ft' must be in metres"},
    {"a.csv", "1,2,0\n", ":1: target 1-target 2", "above 0"},
    {"a.csv", "1,2,nan\n", ":1: target 1-target 2", "above 0"},
    {"a.csv", "1,2,0.5,-1\n", ":1: target 1-target 2", "above 0"},
    {"a.csv", "1,01,0.5\n", ":1: target 1-target 01", "same"},
    {"a.csv", "1,2,0.5\n2,1,0.4\n", ":2: target 2-target 1", "another length"},
    {"a.csv",
     "1,2,0.5\n",
     "",
     "has no targets in photographs, but scale bars",
     {.role = Role::images}},
    {"a.json", R"({"targets": []})", "", "has no targets in photographs", {.role = Role::images}},
    {"a.csv", "1,2,0.5\n", ":1", "a header that names", {.role = Role::points}},
    {"a.csv", "label,x,y,z\n1,2,3,4\n", "", "no scale bars, but control", {.role = Role::bars}},
    {"a.txt", "EPSG:32617\n1 2 3 4 5\n", ":2", "IMAGE"},
    {"a.txt", "EPSG:32617\n1 2 3 4 x a.jpg\n", ":2", "im_y is 'x'"},
    {"a.txt", "EPSG:32617\n1 nan 3 4 5 a.jpg\n", ":2", "geo_y"},
    {"a.txt", "EPSG:32617\n1 2 3 4 5 a.jpg p\n1 2 4 4 5 b.jpg p\n", ":3: p", "another place"},
    {"a.txt", "EPSG:1\n1 2 3 4 5 a.jpg\n", ":1", "EPSG:1"},
    {"a.txt", "EPSG:2225\n1 2 3 4 5 a.jpg\n", ":1", "not the metre"},
    {"a.xml", "<document><chunk>", "", "is no XML"},
    {"a.xml", "<d><markers><marker id=\"0\"/></markers></d>", ":1", "no label"},
    {"a.xml",
     "<d><markers><marker id=\"0\" label=\"m\"/>\n<marker id=\"0\" label=\"n\"/></markers></d>",
     ":2: n", "occurs twice"},
    {"a.xml",
     "<d><markers><marker id=\"0\" label=\"m\"/></markers>\n<frames><frame><markers><marker "
     "marker_id=\"0\">\n<location camera_id=\"3\" x=\"1\" y=\"2\"/></marker></markers></frame>"
     "</frames></d>",
     ":3", "camera_id is '3'"},
    {"a.xml",
     "<d><markers><marker id=\"0\" label=\"m\">\n<reference x=\"1\" y=\"b\"/></marker></markers>"
     "</d>",
     ":2: m", "y is 'b'"},
    {"a.xml",
     "<d><markers><marker id=\"0\" label=\"m\"><reference x=\"1\" y=\"2\" z=\"3\"/></marker>"
     "</markers>\n<coordinate_system>none</coordinate_system></d>",
     ":2", "'none'"},
    {"a.json", "{}", "", "no targets"},
    {"a.json", R"({"points": 5})", ": points", "list"},
    {"a.json", R"({"points": [5]})", ": points[0]", "object"},
    {"a.json", R"({"points": [{"x": 1}]})", ": points[0].label", "missing"},
    {"a.json", R"({"points": [{"label": "m", "x": "1"}]})", ": points[0].x", "expected a number"},
    {"a.json", R"({"points": [{"label": "m", "x": 1, "height": 1, "z": 2}]})", ": points[0]",
     "both z and height"},
    {"a.json", R"({"points": [{"label": "m", "x": 1, "latitude": 1}]})", ": points[0]", "beside"},
    {"a.json", R"({"points": [{"label": "m", "sigmas": 1}]})",
     ": points[0]: ", "unknown key 'sigmas'"},
    {"a.json", R"({"points": [{"label": "m", "sigma": [1, 2]}]})", ": points[0].sigma",
     "3 numbers"},
    {"a.json", R"({"bars": [{"targets": ["a"], "length": 1}]})", ": bars[0].targets", "two"},
    {"a.json", R"({"bars": [{"targets": ["a", "b"], "length": 0}]})", ": bars[0]: a-b", "above 0"},
    {"a.json", R"({"targets": [{"label": "m", "image": "a", "x": 1}]})", ": targets[0].y",
     "missing"},
    {"a.json", R"({"crs": "EPSG:0", "points": [{"label": "m", "x": 1, "y": 1}]})", ": crs",
     "EPSG:0"},
};

using WrongControl = ControlFiles;

TEST_F(WrongControl, IsOneLineThatNamesThePlace) {
  for (const Wrong& wrong : kWrong) {
    const auto file = put(wrong.name, wrong.text);
    const std::string message =
        test::error_naming(file, [&] { read_control(file, wrong.options); });
    EXPECT_THAT(message, testing::StartsWith(file.string() + wrong.place)) << wrong.text;
    EXPECT_THAT(message, HasSubstr(wrong.expect)) << wrong.text;
    EXPECT_THAT(message, testing::Not(HasSubstr("\n"))) << wrong.text;
  }
}

TEST_F(WrongControl, DamageIsSurvived) {
  const auto read = [](const auto& file) { return read_control(file, {}); };
  for (const char* text : {"label,lat,lon,depth,xyAcc,zAcc\n1,24.5,-81,-3.5,0.02,0.03\n",
                           "EPSG:32617\n1 2 3 4 5 a.jpg p\n5 6 7 8 9 b.jpg q\n",
                           R"({"points": [{"label": "m", "x": 1, "y": 2, "z": 3, "sigma": 0.1}]})",
                           "<d><markers><marker id=\"0\" label=\"m\"/></markers></d>"})
    test::expect_damage_survived(folder_ / "a.txt", text, read);
}

}  // namespace
}  // namespace axial::control
