// SPDX-License-Identifier: GPL-3.0-or-later
// Maps as files, and maps made from photographs through a port.
#include "map/write_maps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/parallel.h"
#include "map/geotiff.h"
#include "support/empty_folder.h"
#include "support/error_of.h"
#include "texture/painted_room.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;

MapFiles files_in(const fs::path& folder) {
  return {folder / "m.dem.tif",       folder / "m.ortho.tif",        folder / "m.views.tif",
          folder / "m.hillshade.tif", folder / "m.contours.geojson", folder / "m.jpg"};
}

// The room seen from above, with colours from eight photographs through a flat port. `levels`: of
// refined().
struct RoomMap {
  TexturedMesh mesh;
  std::vector<std::uint16_t> views;
  MapContent content;

  explicit RoomMap(double pixel, int levels = 3) : content{mesh, views, {}, {}} {
    const test::Room room = test::photograph_room(8);
    mesh =
        texture::texture_mesh(test::refined(test::room_mesh(), levels), room.views, room.source());
    views.assign(mesh.mesh.faces.size(), 8);
    content.views = views;
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

TEST(WriteMaps, BlocksThreadsAndMemoryHaveNoEffect) {
  const RoomMap room(0.011);
  const fs::path folder = test::empty_folder();
  const MapFiles files = files_in(folder);
  std::vector<std::string> first;
  for (const int size : {512, 64, 1024}) {
    const ThreadLimit limit(size == 512 ? 1 : 2);
    write_maps(
        files, room.content,
        {.block_size = size, .contour_interval = 0.15, .memory = {size == 64 ? 2000u : 0, "", 0}});
    std::vector<std::string> bytes;
    for (const fs::path& file : files.all()) bytes.push_back(read_file(file));
    if (first.empty()) first = bytes;
    EXPECT_EQ(bytes, first) << size;
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 6);
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
  const MapContent content{plain, {}, room.content.frame, room.content.grid};
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
  EXPECT_THAT(
      test::error_of([&] {
        write_maps(files, room.content, {.contour_interval = 0.15, .memory = {1, "memory", 0}});
      }),
      testing::HasSubstr("memory"));
  EXPECT_EQ(read_file(files.heights), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace axial::map
