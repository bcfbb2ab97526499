// SPDX-License-Identifier: GPL-3.0-or-later
// Maps as files, and maps made from photographs through a port.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "axial/map.h"
#include "base/atomic_file.h"
#include "base/parallel.h"
#include "map/geotiff.h"
#include "scene/any_camera.h"
#include "scene/bilinear.h"
#include "support/empty_folder.h"
#include "support/error_of.h"
#include "texture/painted_room.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;

MapFiles files_in(const fs::path& folder) {
  return {folder / "m.dem.tif",   folder / "m.ortho.tif",     folder / "m.views.tif",
          folder / "m.sigma.tif", folder / "m.hillshade.tif", folder / "m.contours.geojson",
          folder / "m.jpg"};
}

// The room seen from above, with colours from eight photographs through a flat port. `levels`: of
// refined().
struct RoomMap {
  TexturedMesh mesh;
  std::vector<std::uint16_t> views;
  std::vector<float> errors;
  MapContent content;

  explicit RoomMap(double pixel, int levels = 3) : content{mesh, views, errors, {}, {}} {
    const test::Room room = test::photograph_room(8);
    mesh =
        texture::texture_mesh(test::refined(test::room_mesh(), levels), room.views, room.source());
    views.assign(mesh.mesh.faces.size(), 8);
    content.views = views;
    for (std::size_t f = 0; f < mesh.mesh.faces.size(); ++f)
      errors.push_back(f % 5 == 0 ? kNoHeight : 0.001f * static_cast<float>(f % 7));
    content.errors = errors;
    content.frame = frame_with_up({0, 0, 1}, {{500000, 4500000, 0}});
    content.grid = grid_around(mesh.mesh, content.frame, pixel);
  }
};

// Interpolation changes the waves of the pattern by up to 2 % of their amplitude of 51 levels, as
// in texture_mesh_test. Half a pixel of displacement of the map would give a PSNR of 36 dB.
TEST(WriteMaps, ShowTheRoomThroughThePort) {
  const RoomMap room(0.004, 5);
  const MapFiles files = files_in(test::empty_folder());
  const MapReport report =
      write_maps(files, room.content, {.crs = crs_of_epsg(32631), .contour_interval = 0.15});
  const StoredMap heights = read_map(files.heights), colors = read_map(files.colors);
  ASSERT_EQ(heights.pixels.size(), cv::Size(400, 400));
  EXPECT_EQ(report.surface, 160'000);
  double squares = 0;
  std::int64_t colored = 0;
  for (int row = 0; row < 400; ++row)
    for (int column = 0; column < 400; ++column) {
      const double x = heights.grid.left + (column + 0.5) * 0.004 - 500000;
      const double y = heights.grid.top - (row + 0.5) * 0.004 - 4500000;
      if (std::abs(std::abs(y) - 0.15) < 1e-3) continue;  // pixel centres on the box's edge
      const bool on_box = std::abs(x) < 0.2 && std::abs(y) < 0.15;
      ASSERT_EQ(heights.pixels.at<float>(row, column), on_box ? test::kBoxHeight : 0.0f);
      const auto& color = colors.pixels.at<cv::Vec4b>(row, column);
      if (color[3] == 0) continue;
      ++colored;
      const Eigen::Vector3f truth = 255 * test::pattern({x, y, on_box ? 0.2 : 0.0});
      for (int k = 0; k < 3; ++k) squares += std::pow(color[k] - truth[k], 2);
    }
  EXPECT_LE(colored, report.colored);
  EXPECT_GT(colored, report.colored - 1000);
  EXPECT_GT(colored, 60'000);
  const double psnr = 10 * std::log10(255.0 * 255 / (squares / (3 * static_cast<double>(colored))));
  EXPECT_GT(psnr, 42);
}

// The map of the room from one photograph without visibility: R G B, black outside of it.
cv::Mat3b naive_map(const test::Room& room, const StoredMap& heights) {
  const AnyCamera<double> camera(make_camera<double>(room.views[0].camera));
  cv::Mat3b map(heights.pixels.size(), cv::Vec3b(0, 0, 0));
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.cols; ++column) {
      const Eigen::Vector3d point(heights.grid.left + (column + 0.5) * heights.grid.pixel - 500000,
                                  heights.grid.top - (row + 0.5) * heights.grid.pixel - 4500000,
                                  static_cast<double>(heights.pixels.at<float>(row, column)));
      const auto image = camera.project(room.views[0].pose.to_camera(point));
      const auto size = room.images[0].color.size();
      if (!image.visible || image.pixel.minCoeff() < 0 || image.pixel.x() > size.width - 1 ||
          image.pixel.y() > size.height - 1)
        continue;
      const Eigen::Vector3f bgr = bilinear(room.images[0].color, image.pixel.cast<float>());
      map(row, column) = cv::Vec3b(cv::Vec3f(bgr[2], bgr[1], bgr[0]));
    }
  return map;
}

// The share of the rows across the box's left side with exactly one edge of red, there. The step is
// 77 levels; the waves of the pattern have less than 8 levels per pixel.
double rows_with_one_edge(const cv::Mat3b& map) {
  int rows = 0, good = 0;
  for (int row = 175; row < 225; ++row) {  // y from -0.1 to 0.1
    int edges = 0;
    bool is_there = false;
    const auto step = [&](int x) { return std::abs(map(row, x + 1)[0] - map(row, x - 1)[0]); };
    for (int x = 75; x < 190; ++x) {  // x from -0.5 to -0.04; the side is at column 150
      if (step(x) < 30 || step(x) < step(x - 1) || step(x) <= step(x + 1)) continue;
      ++edges;
      is_there |= std::abs(x - 149.5) < 2;
    }
    ++rows;
    good += edges == 1 && is_there;
  }
  return good / static_cast<double>(rows);
}

// The box hides the floor at its left from photograph 0, which other photographs see. A map without
// visibility shows the box there a second time.
TEST(WriteMaps, DepthStepsHaveOneEdge) {
  const RoomMap room(0.004, 5);
  MapFiles files;
  const fs::path folder = test::empty_folder();
  files.heights = folder / "m.dem.tif", files.colors = folder / "m.ortho.tif";
  write_maps(files, room.content, {});
  const StoredMap heights = read_map(files.heights), stored = read_map(files.colors);
  const cv::Mat beside = stored.pixels(cv::Rect(75, 175, 115, 50));
  cv::Mat1b alpha;
  cv::extractChannel(beside, alpha, 3);
  EXPECT_EQ(cv::countNonZero(alpha), alpha.size().area());
  cv::Mat3b colors;
  cv::cvtColor(stored.pixels, colors, cv::COLOR_RGBA2RGB);
  EXPECT_EQ(rows_with_one_edge(colors), 1);
  EXPECT_LT(rows_with_one_edge(naive_map(test::photograph_room(8), heights)), 0.1);
}

TEST(WriteMaps, BlocksThreadsAndMemoryHaveNoEffect) {
  const RoomMap room(0.011);
  const fs::path folder = test::empty_folder();
  const MapFiles files = files_in(folder);
  std::vector<std::string> first;
  for (const int size : {512, 64, 1024}) {
    const ThreadLimit limit(size == 512 ? 1 : 2);
    write_maps(files, room.content, {.block_size = size, .contour_interval = 0.15},
               Context({}, {}, {MemoryBudget::of_program(size == 64 ? 2000u : 0)}));
    std::vector<std::string> bytes;
    for (const fs::path& file : files.all()) bytes.push_back(read_file(file));
    if (first.empty()) first = bytes;
    EXPECT_EQ(bytes, first) << size;
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 7);
}

// The box of 0.4 m x 0.3 m and 0.2 m height: one closed line at 0.15 m, about on its sides.
TEST(WriteMaps, ContoursGoAroundTheBox) {
  const RoomMap room(0.011);
  const MapFiles files = files_in(test::empty_folder());
  write_maps(files, room.content, {.crs = crs_of_epsg(32631), .contour_interval = 0.15});
  const auto json = nlohmann::json::parse(read_file(files.contours));
  std::vector<nlohmann::json> lines;
  for (const auto& feature : json["features"])
    if (feature["properties"]["height"] == 0.15) lines.push_back(feature["geometry"]);
  ASSERT_EQ(lines.size(), 1u);
  const auto& points = lines[0]["coordinates"];
  ASSERT_GT(points.size(), 50u);
  EXPECT_EQ(points.front(), points.back());
  for (const auto& point : points) {
    const double x = std::abs(point[0].get<double>() - 500000) / 0.2;
    const double y = std::abs(point[1].get<double>() - 4500000) / 0.15;
    EXPECT_NEAR(std::max(x, y), 1, 0.011 / 0.15);
  }
}

TEST(WriteMaps, FilesThatAreNotAskedForAreNotWritten) {
  RoomMap room(0.05);
  const fs::path folder = test::empty_folder();
  TexturedMesh plain;
  plain.mesh = room.mesh.mesh;
  const MapContent content{plain, {}, {}, room.content.frame, room.content.grid};
  MapFiles files;
  files.heights = folder / "m.dem.tif";
  write_maps(files, content, {});
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
  EXPECT_THAT(
      test::error_of([&] { write_maps(files_in(folder), content, {.contour_interval = 1}); }),
      testing::HasSubstr("no textures"));
}

TEST(WriteMaps, OldFilesStayIfMemoryDoesNotSuffice) {
  const RoomMap room(0.011);
  const fs::path folder = test::empty_folder();
  const MapFiles files = files_in(folder);
  write_atomically(files.heights, "old");
  EXPECT_THAT(test::error_of([&] {
                write_maps(files, room.content, {.contour_interval = 0.15},
                           Context({}, {}, {MemoryBudget::of_program(1)}));
              }),
              testing::HasSubstr("memory"));
  EXPECT_EQ(read_file(files.heights), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace axial::map
