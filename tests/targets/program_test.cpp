// SPDX-License-Identifier: GPL-3.0-or-later
// FindTargets, with photographs drawn from the patterns.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "base/atomic_file.h"
#include "io/bytes/json.h"
#include "io/images/image.h"
#include "support/program_run.h"
#include "targets/codes/ring_codes.h"
#include "targets/drawn_plate.h"

namespace axial::targets {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class FindTargets : public test::ProgramTest {
 protected:
  // A photograph of a plate whose centre is at `centre` (COLMAP's convention).
  void write(const std::string& name, const std::string& family, std::size_t number,
             const Eigen::Vector2d& centre, int bits = 8) const {
    test::PlateView view;
    view.centre = centre;
    cv::Mat picture = test::photograph(view, Pattern(parse_family(family), number));
    if (bits == 16) picture.convertTo(picture, CV_16U, 256);
    fs::create_directories((folder_ / name).parent_path());
    io::write_png(folder_ / name, picture);
  }
  nlohmann::json targets() const { return io::read_json(folder_ / "out.json").at("targets"); }
  void refuses(const std::string& arguments, const std::string& expected) const {
    expect_refusal("FindTargets", arguments + " -v 0", expected);
    EXPECT_FALSE(fs::exists(folder_ / "out.json"));
  }
};

TEST_F(FindTargets, ListsTheTargetsOfAFolderInColmapsPixels) {
  write("dive/a/1.png", "circular12", 7, {101.25, 90.5});
  write("dive/b/1.png", "APRILTAG_36h11", 12, {130.5, 100.75}, 16);
  succeed_in("FindTargets", "dive -o out.json --pictures pictures");
  const nlohmann::json found = targets();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].at("label"), "target 7");
  EXPECT_EQ(found[0].at("image"), "a/1.png");
  EXPECT_NEAR(found[0].at("x"), 101.25, 0.05);
  EXPECT_NEAR(found[0].at("y"), 90.5, 0.05);
  EXPECT_EQ(found[0].at("dot").size(), 3u);
  EXPECT_EQ(found[1].at("label"), "tag 12");
  EXPECT_EQ(found[1].at("image"), "b/1.png");
  EXPECT_NEAR(found[1].at("x"), 130.5, 0.05);
  EXPECT_NEAR(found[1].at("y"), 100.75, 0.05);
  EXPECT_EQ(found[1].at("corners").size(), 4u);
  const nlohmann::json images = io::read_json(folder_ / "out.json").at("images");
  EXPECT_EQ(images.at(0).at("width"), 320);
  EXPECT_TRUE(fs::exists(folder_ / "pictures/a/1.png/target-7.jpg"));
  EXPECT_TRUE(fs::exists(folder_ / "pictures/b/1.png/tag-12.jpg"));
}

TEST_F(FindTargets, TwoPlatesWithOneCodeAreNamed) {
  test::PlateView view;
  view.centre = {80, 120};
  const Pattern pattern(parse_family("4X4_50"), 3);
  cv::Mat1b left = test::photograph(view, pattern), both;
  cv::flip(left, both, -1);  // half a turn is a turned plate
  both.colRange(0, 160) = left.colRange(0, 160) + 0;
  io::write_png(folder_ / "1.png", both);
  const std::string output = succeed_in("FindTargets", "1.png -o out.json --families 4X4_50");
  EXPECT_EQ(targets().size(), 2u);
  EXPECT_THAT(output, HasSubstr("1.png: shows tag 3 at 2 places"));
  EXPECT_THAT(output, HasSubstr("tag 3: is in 1.png only"));
}

TEST_F(FindTargets, TheSameBytesForAnyNumberOfThreads) {
  for (int i = 0; i < 4; ++i)
    write(fmt::format("dive/{}.png", i), "circular12", static_cast<std::size_t>(i + 1),
          {100.0 + i, 100});
  succeed_in("FindTargets", "dive -o one.json --max-threads 1 --pictures one");
  succeed_in("FindTargets", "dive -o two.json --max-threads 2 --pictures two");
  for (int i = 0; i < 4; ++i) {
    const std::string picture = fmt::format("{}.png/target-{}.jpg", i, i + 1);
    EXPECT_TRUE(read_file(folder_ / "one" / picture) == read_file(folder_ / "two" / picture));
  }
  EXPECT_TRUE(read_file(folder_ / "one.json") == read_file(folder_ / "two.json"));
}

TEST_F(FindTargets, WritesFilesOfOtherPrograms) {
  write("dive/1.png", "circular12", 7, {101.25, 90.5});
  write("dive/2.png", "circular12", 8, {130.5, 100.75});
  write_atomically(folder_ / "plates.csv", "label,x,y,z\n7,500000,2500000,-3\n");
  write_atomically(folder_ / "bars.txt", "7,8,0.5\n");
  succeed_in("FindTargets", "dive -o gcp.txt --control plates.csv --epsg 32617");
  std::istringstream list(read_file(folder_ / "gcp.txt"));
  std::string system, image, label;
  double x = 0, y = 0, z = 0, column = 0, row = 0;
  ASSERT_TRUE(list >> system >> x >> y >> z >> column >> row >> image >> label);
  EXPECT_EQ(system, "EPSG:32617");
  EXPECT_EQ(z, -3);
  EXPECT_NEAR(column, 101.25, 0.05);
  EXPECT_NEAR(row, 90.5, 0.05);
  EXPECT_EQ(image, "1.png");
  EXPECT_EQ(label, "target_7");
  EXPECT_FALSE(list >> label);  // target 8 has no place
  succeed_in("FindTargets", "dive -o markers.xml --control plates.csv --control bars.txt");
  const std::string markers = read_file(folder_ / "markers.xml");
  EXPECT_THAT(markers, HasSubstr("label=\"target 8\""));
  EXPECT_THAT(markers, HasSubstr("distance=\"0.5\""));
  EXPECT_THAT(markers, HasSubstr("z=\"-3\""));
}

TEST_F(FindTargets, TakesLabelsFromATable) {
  write("1.png", "circular12", 7, {101.25, 90.5});
  const std::uint32_t code = ring_codes(12)[6];
  write_atomically(folder_ / "table.csv", fmt::format("{},north\n", code));
  succeed_in("FindTargets", "1.png -o out.json --families circular12 --target-table table.csv");
  ASSERT_EQ(targets().size(), 1u);
  EXPECT_EQ(targets()[0].at("label"), "north");
  EXPECT_EQ(targets()[0].at("code"), code);
}

TEST_F(FindTargets, WrongInputIsRefusedInOneLine) {
  write("dive/1.png", "circular12", 7, {100, 100});
  write_atomically(folder_ / "dive/2.png", "no image");
  fs::create_directories(folder_ / "empty");
  refuses("dive -o out.json", "2.png");
  refuses("empty -o out.json", "empty: contains no photographs");
  refuses("absent -o out.json", "absent: does not exist");
  refuses("dive/1.png", "--output-file is required");
  refuses("dive/1.png -o dive/1.png", "--output-file");
  write("more/1.png", "circular12", 7, {100, 100});
  refuses("-i dive/1.png -i more -o out.json", "1.png: has the same name as");
  refuses("more -o more/1.png", "--output-file");
  refuses("more -o out.json --pictures more/pictures", "lies in the folder of the photographs");
  refuses("more -o out.json --side 0.2", "--side: needs --print");
  refuses("more -o out.txt", "--output-file");
  refuses("more -o out.json --control absent", "--control: is for an output file .txt or .xml");
  refuses("more -o out.xml --control absent", "absent");
  refuses("more -o out.xml --epsg 32617", "--epsg: needs --control");
  write_atomically(folder_ / "table.csv", "4,a\n");
  refuses("more -o out.json --families circular12 --target-table table.csv", "table.csv:1: '4'");
  refuses("more -o out.json --target-table table.csv", "--target-table: needs --families with one");
  refuses("--print plates --plates 1 --families charuco:7x5:0.04:0.03", "--families is a board");
  refuses("more -o out.json --max-memory 20", "--max-memory");
  refuses("more -o out.json --families ''", "names no family");
  refuses("--print plates --plates 18446744073709551615 --families circular12", "is not a range");
  refuses("--print plates --plates 1-3 --bars 3,4,0.5 --families circular12",
          "target 3 would be drawn twice");
  refuses("--print plates --plates 1 --families circular12 -o out.json", "--output-file: is for");
  refuses("dive/1.png -o out.json --families circular13", "'circular13' is not a family");
  refuses("dive/1.png -o out.json --families 4X4_50,5X5_50", "would have equal labels");
  refuses("dive/1.png -o out.json --plates 1", "--plates: needs --print");
  refuses("--print plates --families circular12", "--print: needs --plates or --bars");
  refuses("--print plates --plates 1", "--print: needs --families with one family");
  refuses("--print plates --plates 4-1 --families circular12", "'4-1' is not a range");
  refuses("--print plates --plates 999 --families circular12",
          "circular12 999: the targets are numbered from 1 to");
  refuses("--print plates --bars 1,2 --families circular12", "is not TARGET,TARGET,LENGTH");
  refuses("--print plates --bars 1,2,0.05 --families circular12", "too short");
  EXPECT_FALSE(fs::exists(folder_ / "plates"));
}

// The numbers in all attributes `name` of a drawing.
std::vector<double> attributes(const std::string& drawing, const std::string& name) {
  const std::regex pattern(" " + name + "=\"([-0-9.e]+)(mm)?\"");
  std::vector<double> values;
  for (std::sregex_iterator match(drawing.begin(), drawing.end(), pattern), end; match != end;
       ++match)
    values.push_back(std::stod((*match)[1]));
  return values;
}

// The black cells of the drawing are those of the pattern.
TEST_F(FindTargets, PrintsPlatesToScale) {
  succeed_in("FindTargets", "--print plates --plates 5 --families APRILTAG_36h11 --side 0.2");
  const std::string drawing = read_file(folder_ / "plates/plate-5.svg");
  EXPECT_DOUBLE_EQ(attributes(drawing, "width").front(), 220);
  const Pattern pattern(parse_family("APRILTAG_36h11"), 5);
  double drawn = 0, black = 0;
  const auto widths = attributes(drawing, "width");
  for (std::size_t i = 2; i < widths.size(); ++i) drawn += widths[i];
  for (double y = -3.5; y < 4; ++y)
    for (double x = -3.5; x < 4; ++x) black += !pattern.white(x, y);
  EXPECT_DOUBLE_EQ(drawn, black);
  EXPECT_THAT(drawing, HasSubstr("scale(20.000000)"));  // 200 mm for 10 cells
}

TEST_F(FindTargets, PrintsBarsToScale) {
  succeed_in("FindTargets", "--print plates --bars '1,2,0.5;3,4,1' --families circular12");
  const std::string drawing = read_file(folder_ / "plates/bar-1-2.svg");
  const std::regex place("translate\\(([0-9.]+) ([0-9.]+)\\) scale\\(([0-9.]+)\\)");
  std::vector<std::array<double, 3>> places;
  for (std::sregex_iterator match(drawing.begin(), drawing.end(), place), end; match != end;
       ++match)
    places.push_back({std::stod((*match)[1]), std::stod((*match)[2]), std::stod((*match)[3])});
  ASSERT_EQ(places.size(), 2u);
  EXPECT_NEAR(places[1][0] - places[0][0], 500, 1e-9);
  EXPECT_DOUBLE_EQ(places[0][1], places[1][1]);
  EXPECT_DOUBLE_EQ(places[0][2], 12.5);  // 100 mm for 8 radii of the dot
  EXPECT_TRUE(fs::exists(folder_ / "plates/bar-3-4.svg"));
}

}  // namespace
}  // namespace axial::targets
