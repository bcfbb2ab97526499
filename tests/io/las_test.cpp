// SPDX-License-Identifier: GPL-3.0-or-later
// The places of fields in these tests are those of the LAS specification 1.4, R15.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

#include "base/atomic_file.h"
#include "io/las/cloud_to_las.h"
#include "io/wrong_input.h"
#include "las/private/las_writer.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

template <class T>
T at(std::string_view bytes, std::size_t place) {
  T value;
  EXPECT_LE(place + sizeof(T), bytes.size());
  std::memcpy(&value, bytes.substr(place, sizeof(T)).data(), sizeof(T));
  return value;
}

constexpr LasLayout kAll{true, true, true, true};

TEST(LasHeader, CountsMorePointsThanFitIn32Bits) {
  const std::uint64_t many = 5'000'000'000;
  const std::string bytes = las_header({kAll, {}, "", many});
  EXPECT_EQ(at<std::uint64_t>(bytes, 247), many);
  EXPECT_EQ(at<std::uint64_t>(bytes, 255), many);  // first returns
  for (std::size_t k = 1; k < 15; ++k) EXPECT_EQ(at<std::uint64_t>(bytes, 255 + 8 * k), 0u);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(at<std::uint32_t>(bytes, 107 + 4 * k), 0u);
}

TEST(LasHeader, StatesFormatAndLengths) {
  const std::string bytes = las_header({kAll, {}, "PROJCS[]", 1});
  EXPECT_EQ(bytes.substr(0, 4), "LASF");
  EXPECT_EQ(at<std::uint16_t>(bytes, 6), 16);  // the reference system is WKT
  EXPECT_EQ(bytes.substr(24, 2), std::string("\1\4"));
  EXPECT_EQ(at<std::uint16_t>(bytes, 94), 375);
  EXPECT_EQ(at<std::uint32_t>(bytes, 96), bytes.size());
  EXPECT_EQ(bytes.size(), 375u + (54 + 9) + (54 + 6 * 192));
  EXPECT_EQ(at<std::uint32_t>(bytes, 100), 2u);
  EXPECT_EQ(bytes[104], 7);
  EXPECT_EQ(at<std::uint16_t>(bytes, 105), 36 + 3 * 4 + 2 + 2 * 4);
  EXPECT_EQ(bytes.substr(377, 16), std::string("LASF_Projection") + '\0');
  EXPECT_EQ(bytes.substr(375 + 54, 9), std::string("PROJCS[]") + '\0');
  for (std::size_t extra = bytes.size() - 6 * 192; extra < bytes.size(); extra += 192) {
    EXPECT_EQ(bytes[extra + 4 + 31], '\0');  // name and description end with a zero
    EXPECT_EQ(bytes[extra + 160 + 31], '\0');
  }
}

TEST(LasHeader, LeavesOutWhatACloudLacks) {
  const std::string bytes = las_header({{}, {}, "", 1});
  EXPECT_EQ(bytes.size(), 375u);
  EXPECT_EQ(at<std::uint32_t>(bytes, 100), 0u);
  EXPECT_EQ(bytes[104], 6);
  EXPECT_EQ(at<std::uint16_t>(bytes, 105), 30);
}

// A position is wrong by half a step, and by the rounding of a double in the world (1e-9 at 1e7).
RC_GTEST_PROP(LasGrid, KeepsAnyPositionOfABox, ()) {
  const auto unit = [] { return *rc::gen::inRange(-1000000, 1000001) / 1e6; };
  const Eigen::Vector3d middle = 1e7 * Eigen::Vector3d(unit(), unit(), unit());
  const double half = std::pow(10.0, 2 + 4 * unit());  // 0.01 to 1e6
  const Eigen::Vector3d low = middle.array() - half, high = middle.array() + half;
  const std::optional<LasGrid> grid = las_grid(low, high);
  RC_ASSERT(grid.has_value());
  const Eigen::Vector3d inside = middle + half * Eigen::Vector3d(unit(), unit(), unit());
  for (const Eigen::Vector3d& x : {low, high, inside}) {
    const Eigen::Vector3d again = grid->world(grid->stored(x));
    RC_ASSERT((again - x).cwiseAbs().maxCoeff() <= grid->scale / 2 + 1e-8);
  }
}

TEST(LasGrid, IsAsFineAsTheSizeAllows) {
  const auto step = [](double half) {
    const std::optional<LasGrid> grid =
        las_grid(Eigen::Vector3d::Constant(-half), Eigen::Vector3d::Constant(half));
    return grid ? grid->scale : 0;
  };
  EXPECT_EQ(step(0), 1e-6);
  EXPECT_EQ(step(2147), 1e-6);
  EXPECT_EQ(step(2148), 1e-5);
  EXPECT_EQ(step(21474), 1e-5);
  EXPECT_EQ(step(21475), 1e-4);
  EXPECT_EQ(step(214749), 1e-3);
  EXPECT_EQ(step(2147483), 1e-3);
  EXPECT_EQ(step(2147484), 0);
  EXPECT_EQ(step(1e308), 0);
  EXPECT_EQ(step(std::numeric_limits<double>::infinity()), 0);
}

TEST(LasGrid, IsForFiniteBoxes) {
  const Eigen::Vector3d low(-1, -1, -1), high(1, 1, 1);
  ASSERT_TRUE(las_grid(low, high));
  for (Eigen::Index k = 0; k < 3; ++k)
    for (const double value :
         {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
      Eigen::Vector3d low_there = low, high_there = high;
      low_there(k) = -value, high_there(k) = value;
      EXPECT_FALSE(las_grid(low_there, high)) << k << ' ' << value;
      EXPECT_FALSE(las_grid(low, high_there)) << k << ' ' << value;
      EXPECT_FALSE(las_grid(low_there, high_there)) << k << ' ' << value;
    }
}

TEST(LasGrid, TellsWhichPositionsFit) {
  const LasGrid grid{Eigen::Vector3d(10, 20, 30), 1e-6};
  EXPECT_TRUE(grid.holds({10, 20, 30}));
  for (Eigen::Index k = 0; k < 3; ++k)
    for (const double sign : {-1.0, 1.0}) {
      Eigen::Vector3d x = grid.offset;
      x(k) += sign * 2147;  // 2^31 steps are 2147.48
      EXPECT_TRUE(grid.holds(x)) << x.transpose();
      x(k) += sign;
      EXPECT_FALSE(grid.holds(x)) << x.transpose();
      x(k) = sign * std::numeric_limits<double>::infinity();
      EXPECT_FALSE(grid.holds(x)) << x.transpose();
    }
  EXPECT_FALSE(grid.holds({10, std::numeric_limits<double>::quiet_NaN(), 30}));
}

class LasTest : public test::FolderTest {
 protected:
  LasReport convert(std::string_view ply, const LocalFrame& frame = {}, const std::string& crs = {},
                    const Context& context = {}) {
    test::put(ply_, ply);
    return write_cloud_as_las(ply_, las_, frame, crs, context);
  }
  std::string error(std::string_view ply) {
    return test::error_naming(ply_, [&] { convert(ply); });
  }
  std::string las() const { return read_file(las_); }
  // The points of a file without records.
  Eigen::Vector3d position(std::size_t point, std::size_t bytes = 30) const {
    const std::string file = las();
    Eigen::Vector3d x;
    for (std::size_t k = 0; k < 3; ++k)
      x(static_cast<Eigen::Index>(k)) =
          at<std::int32_t>(file, 375 + point * bytes + 4 * k) * at<double>(file, 131 + 8 * k) +
          at<double>(file, 155 + 8 * k);
    return x;
  }

  fs::path ply_ = folder_ / "cloud.ply", las_ = folder_ / "cloud.las";
};

std::string ascii(const std::string& properties, const std::string& rows, int count,
                  const std::string& comment = {}) {
  return "ply\nformat ascii 1.0\n" + comment + "element vertex " + std::to_string(count) + "\n" +
         properties + "end_header\n" + rows;
}

const std::string kFloat = "property float x\nproperty float y\nproperty float z\n";
const std::string kDouble = "property double x\nproperty double y\nproperty double z\n";

TEST_F(LasTest, KeepsTheDigitsOfDoubleCoordinates) {
  const LasReport report =
      convert(ascii(kDouble, "534012.345678 3378487.654321 -30.000001\n534013 3378488 -29\n", 2));
  EXPECT_EQ(report.points, 2u);
  EXPECT_EQ(report.step, 1e-6);
  // Half a step is 5e-7; a double at 3e6 has steps of 5e-10.
  EXPECT_LT((position(0) - Eigen::Vector3d(534012.345678, 3378487.654321, -30.000001)).norm(),
            2e-9);
  EXPECT_LT((position(1) - Eigen::Vector3d(534013, 3378488, -29)).norm(), 2e-9);
  EXPECT_EQ(report.low, position(0));
  EXPECT_EQ(report.high, position(1));
  for (std::size_t k = 0; k < 3; ++k) {  // largest and smallest coordinates
    EXPECT_EQ(at<double>(las(), 179 + 16 * k), position(1)(static_cast<Eigen::Index>(k)));
    EXPECT_EQ(at<double>(las(), 187 + 16 * k), position(0)(static_cast<Eigen::Index>(k)));
  }
}

TEST_F(LasTest, AddsTheOffsetOfTheFileOrOfTheScene) {
  const Eigen::Vector3d expected(534001.5, 3378502.25, -3);
  convert(ascii(kFloat, "1.5 2.25 -3\n", 1, "comment geo_offset 534000 3378500 0\n"));
  EXPECT_EQ(position(0), expected);
  convert(ascii(kFloat, "1.5 2.25 -3\n", 1), {{534000, 3378500, 0}});
  EXPECT_EQ(position(0), expected);
  // A cloud in the world that states no offset is nearer to the origin of the scene.
  convert(ascii(kDouble, "534001.5 3378502.25 -3\n", 1), {{534000, 3378500, 0}});
  EXPECT_EQ(position(0), expected);
}

TEST_F(LasTest, WritesEveryPropertyOfAPoint) {
  convert(ascii(kFloat +
                    "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float "
                    "nx\nproperty float ny\nproperty float nz\nproperty list uchar uint "
                    "view_indices\nproperty list uchar float view_weights\nproperty float "
                    "error\nproperty float confidence\n",
                "1 2 3 0 128 255 0.6 0 -0.8 3 5 6 9 3 1 1 1 0.25 0.5\n", 1));
  const std::string file = las();
  const std::size_t begin = at<std::uint32_t>(file, 96);
  ASSERT_EQ(file.size(), begin + 58);
  const std::string_view point = std::string_view(file).substr(begin);
  EXPECT_EQ(at<std::uint8_t>(point, 14), 0x11);  // return 1 of 1
  EXPECT_EQ(point.substr(15, 15), std::string(15, '\0'));
  EXPECT_EQ(at<std::uint16_t>(point, 30), 0);
  EXPECT_EQ(at<std::uint16_t>(point, 32), 128 * 257);
  EXPECT_EQ(at<std::uint16_t>(point, 34), 65535);
  EXPECT_EQ(at<float>(point, 36), 0.6f);
  EXPECT_EQ(at<float>(point, 44), -0.8f);
  EXPECT_EQ(at<std::uint16_t>(point, 48), 3);
  EXPECT_EQ(at<float>(point, 50), 0.25f);
  EXPECT_EQ(at<float>(point, 54), 0.5f);
}

// More points than the buffer of the writer holds.
TEST_F(LasTest, WritesLongCloudsAndTellsProgress) {
  constexpr int kPoints = 70000;
  std::ostringstream rows;
  for (int i = 0; i < kPoints; ++i) rows << i << ' ' << -i << " 0.5\n";
  std::size_t done = 0, total = 0, events = 0;
  const Context context([&](const Event& event) {
    if (event.kind != Event::Kind::progress) return;
    EXPECT_GE(event.done, done);
    done = event.done;
    total = event.total;
    ++events;
  });
  const std::string ply = ascii(kFloat, rows.str(), kPoints);
  EXPECT_EQ(convert(ply, {}, {}, context).points, std::uint64_t{kPoints});
  EXPECT_EQ(done, std::size_t{kPoints});
  EXPECT_EQ(total, done);
  EXPECT_GE(events, 3u);
  const std::string first = las();
  EXPECT_EQ(first.size(), 375u + 30 * kPoints);
  EXPECT_EQ(at<std::uint64_t>(first, 247), std::uint64_t{kPoints});
  for (const int i : {0, 1, 34951, 34952, kPoints - 1})
    EXPECT_LT((position(static_cast<std::size_t>(i)) - Eigen::Vector3d(i, -i, 0.5)).norm(), 1e-9);
  convert(ply);
  EXPECT_TRUE(las() == first);
}

TEST_F(LasTest, RefusesWrongInputAndKeepsAnOlderFile) {
  test::put(las_, "older");
  EXPECT_THAT(error(ascii(kFloat, "", 0)), HasSubstr("has no points"));
  EXPECT_THAT(error(ascii(kFloat, "1 2 nan\n", 1)),
              HasSubstr("vertex 0 has a position that is not"));
  EXPECT_THAT(error(ascii(kFloat, "1 2 3\n1 2\n", 2)), HasSubstr("truncated"));
  EXPECT_THAT(error(ascii("property float x\n", "1\n", 1)), HasSubstr("has no x, y or z"));
  EXPECT_THAT(error(ascii(kDouble, "0 0 0\n1e7 0 0\n", 2)),
              HasSubstr("its points are 1e+07 apart, and LAS has room for 4.2e+06"));
  EXPECT_THAT(error(ascii(kDouble, "-1e308 0 0\n1e308 0 0\n", 2)), HasSubstr("inf apart"));
  EXPECT_THAT(
      error("ply\nformat ascii 1.0\nelement vertex 3\n" + kFloat +
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 "
            "0\n0 1 0\n3 0 1 2\n"),
      HasSubstr("is a mesh, and LAS holds clouds"));
  std::string views = "1 2 3 65536";
  for (int i = 0; i < 65536; ++i) views += " 7";
  EXPECT_THAT(error(ascii(kFloat + "property list uint uint view_indices\n", views + "\n", 1)),
              HasSubstr("has 65536 views"));
  EXPECT_THAT(error("ply\nformat binary_little_endian 1.0\nelement vertex 9000000000000000000\n" +
                    kFloat + "end_header\n"),
              HasSubstr("vertex"));
  EXPECT_EQ(las(), "older");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 2);
}

// As for a cloud that another program changes between its two passes.
TEST_F(LasTest, RefusesAPointOutsideOfTheGrid) {
  test::put(las_, "older");
  const std::string error = test::error_naming(las_, [&] {
    LasWriter writer(las_, {}, {Eigen::Vector3d(10, 20, 30), 1e-6}, "");
    writer.add({Eigen::Vector3d(10, 20, 31)});
    writer.add({Eigen::Vector3d(10, 5000, 30)});
  });
  EXPECT_THAT(error, HasSubstr("has no room for the point 10 5000 30"));
  EXPECT_EQ(las(), "older");
}

TEST_F(LasTest, RefusesAnOutputThatCannotBeWritten) {
  test::put(ply_, ascii(kFloat, "1 2 3\n", 1));
  const fs::path there = folder_ / "missing" / "cloud.las";
  test::error_naming(there, [&] { write_cloud_as_las(ply_, there, {}, {}); });
  EXPECT_THAT(test::error_of([&] { write_cloud_as_las(ply_, las_, {}, std::string(65535, 'x')); }),
              HasSubstr("has 65535 bytes"));
}

}  // namespace
}  // namespace axial::io
