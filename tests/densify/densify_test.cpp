// SPDX-License-Identifier: GPL-3.0-or-later
// The whole library on photographs of a textured floor.
#include "axial/densify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "densify/floor_fixture.h"
#include "io/openmvs/mvs.h"
#include "io/ply/ply.h"
#include "support/captured_events.h"
#include "support/error_of.h"

namespace axial::densify {
namespace {

namespace fs = std::filesystem;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class Densify : public FloorTest {};

TEST_F(Densify, MakesACloudOnTheSurfaceAndReportsIt) {
  SceneFacts facts{true, true, true};
  const Report report = densify(options_, [&](const SceneFacts& found) { facts = found; });
  EXPECT_FALSE(facts.behind_ports);
  EXPECT_FALSE(facts.own_region);
  EXPECT_FALSE(facts.region);  // the cameras do not surround an object
  EXPECT_EQ(report.result, Result::dense_cloud);
  EXPECT_EQ(report.cloud, folder_ / "out" / "dense.ply");
  EXPECT_EQ(report.depth_maps, 4u);
  EXPECT_TRUE(report.only_pinholes);
  const PointCloud cloud = io::read_cloud_ply(report.cloud);
  EXPECT_EQ(report.points, cloud.size());
  // Half of the pixels that all images see, each at most once.
  EXPECT_GT(cloud.size(), 5000u);
  std::size_t near = 0;
  for (const Eigen::Vector3f& point : cloud.positions) {
    const Eigen::Vector3d place = point.cast<double>();
    const double depth = floor_.depth(Eigen::Vector3d::Zero(), place.normalized());
    // Half a pixel of disparity: 4 m^2 / (150 px * 0.25 m) / 2.
    near += std::abs(place.norm() - depth) < 0.053 ? 1 : 0;
  }
  EXPECT_GT(near, cloud.size() * 9 / 10);
  EXPECT_EQ(io::read_mvs(options_.output.scene, options_.survey.files.working_folder).images.size(),
            4u);
}

TEST_F(Densify, ASecondRunUsesTheDepthMapsOfTheFirst) {
  densify(options_);
  const auto written = fs::last_write_time(map(2));
  const std::string cloud = read_file(folder_ / "out" / "dense.ply");
  fs::remove(map(1));
  densify(options_);
  EXPECT_EQ(fs::last_write_time(map(2)), written);
  EXPECT_TRUE(fs::exists(map(1)));
  EXPECT_EQ(read_file(folder_ / "out" / "dense.ply"), cloud);
  options_.matching.iterations = 1;
  densify(options_);
  EXPECT_NE(fs::last_write_time(map(2)), written);
}

// With the least memory, one image at a time is matched, also by several threads: matching an image
// needs more than the megabyte to which the least memory is rounded up.
TEST_F(Densify, ThreadsAndMemoryDoNotChangeTheCloud) {
  densify(options_);
  const std::string cloud = read_file(folder_ / "out" / "dense.ply");
  use_folder("other");
  const std::uint64_t least = least_memory(options_);
  EXPECT_THAT(test::error_of([&] { densify(options_, {}, with_memory(least - 1)); }),
              HasSubstr("are too little"));
  for (const unsigned threads : {0u, 1u}) {
    use_folder("threads" + std::to_string(threads));
    densify(options_, {}, with_memory(least, threads));
    EXPECT_EQ(read_file(options_.survey.files.working_folder / "dense.ply"), cloud) << threads;
  }
}

TEST_F(Densify, WithoutFusionTheSparsePointsAreTheCloud) {
  options_.fusion.fuse = false;
  options_.matching.geometric_iterations = 0;
  const Report report = densify(options_);
  EXPECT_EQ(report.result, Result::sparse_cloud);
  EXPECT_EQ(report.points, points_);
  EXPECT_EQ(io::read_cloud_ply(report.cloud).size(), points_);
  EXPECT_TRUE(fs::exists(map(3)));
}

TEST_F(Densify, ExportsAndListsMakeNoDepthMaps) {
  options_.job = ExportJob{.export_number_views = 2};
  Report report = densify(options_);
  EXPECT_EQ(report.result, Result::point_export);
  EXPECT_EQ(report.cloud, folder_ / "out" / "dense_2views.ply");
  EXPECT_EQ(report.points, points_);
  options_.job = NeighbourListsJob{folder_ / "lists.txt"};
  report = densify(options_);
  EXPECT_EQ(report.result, Result::neighbour_lists);
  EXPECT_TRUE(report.cloud.empty());
  EXPECT_TRUE(fs::exists(folder_ / "lists.txt"));
  EXPECT_FALSE(fs::exists(map(0)));
}

TEST_F(Densify, RefusesToOverwriteInputs) {
  const std::string tile = "out/dense.tile2-3.ply";
  const std::pair<std::string, std::function<void(Options&)>> cases[] = {
      {"scene.mvs", [&](Options& to) { to.output.scene = to.survey.files.scene; }},
      {"out/dense.ply", [](Options&) {}},
      {tile, [](Options& to) { to.fusion.tiles = 3; }},
      {tile, [](Options& to) { to.fusion.tiles = 3, to.job = TileJob{2}; }}};
  for (const auto& [name, change] : cases) {
    Options options = options_;
    const fs::path file = folder_ / name;
    if (!fs::exists(file)) write_atomically(file, "the caller's");
    const std::string before = read_file(file);
    options.output.other_inputs = {file};
    change(options);
    EXPECT_THAT(test::error_of([&] { densify(options); }), HasSubstr(file.filename().string()));
    EXPECT_EQ(read_file(file), before);
  }
}

TEST_F(Densify, ErrorsNameSettings) {
  fs::create_directories(folder_ / "no_masks");
  const fs::path scene = options_.survey.files.scene;
  const std::pair<const char*, std::function<void(Options&)>> cases[] = {
      {"output ", [&](Options& to) { to.output.scene = scene; }},
      {"report ", [&](Options& to) { to.output.report = scene; }},
      {"neighbour_lists_output ", [&](Options& to) { to.job = NeighbourListsJob{scene}; }},
      {"plan ", [&](Options& to) { to.job = PlanJob{scene}; }},
      {"mask_folder ",
       [&](Options& to) {
         to.survey.mask_folder = folder_ / "no_masks";
         to.survey.ignore_mask_label = 0;
       }},
      {"refractive needs", [](Options& to) { to.survey.files.ports = io::PortChoice::required; }},
      {"make_maps false: ", [](Options& to) { to.matching.make_maps = false; }},
      {"pinhole_export ", [&](Options& to) { to.output.pinhole_export = folder_ / "pinholes"; }}};
  for (const auto& [words, change] : cases) {
    Options options = options_;
    change(options);
    const auto run = [&] { densify(options); };
    EXPECT_THAT(test::error_of(run), AllOf(HasSubstr(words), Not(ContainsRegex("--[a-z]"))));
    const std::string name = std::string(words).substr(0, std::string(words).find(' '));
    EXPECT_THAT(test::bracketed_error_of(run), HasSubstr("<" + name));
  }
  const Context context({}, {}, {MemoryBudget::of_program(1)});
  EXPECT_THAT(test::error_of([&] { densify(options_, {}, context); }),
              StartsWith("max_memory 1: "));
}

// A run that is stopped in each of its stages, and goes on, gives the bytes of one run.
TEST_F(Densify, AStoppedRunGoesOn) {
  densify(options_);
  const std::string expected = read_file(folder_ / "out" / "dense.ply");
  use_folder("stopped");
  const fs::path cloud = folder_ / "stopped" / "dense.ply";
  for (const char* stage :
       {"Estimated depth maps", "Geometric-consistency pass 1", "Fused depth maps"}) {
    std::stop_source source;
    std::size_t done = 0;
    const auto stop = [&](const Event& event) {
      if (event.text != stage || event.done == 0) return;
      ++done;
      source.request_stop();
    };
    EXPECT_THROW(densify(options_, {}, Context(stop, source.get_token())), Stopped);
    EXPECT_GE(done, 1u) << stage;
    EXPECT_FALSE(fs::exists(cloud)) << stage;
  }
  densify(options_);
  EXPECT_TRUE(read_file(cloud) == expected);
}

TEST_F(Densify, WarningsNameSettings) {
  options_.survey.mask_folder = folder_;
  options_.job = NeighbourListsJob{folder_ / "lists.txt"};
  const test::CapturedEvents events;
  densify(options_, {}, events.context);
  EXPECT_THAT(events.lines, HasSubstr("mask_folder " + folder_.string() +
                                      ": is not used, because ignore_mask_label is -1\n"));
  EXPECT_THAT(events.lines, Not(ContainsRegex("--[a-z]")));
}

}  // namespace
}  // namespace axial::densify
