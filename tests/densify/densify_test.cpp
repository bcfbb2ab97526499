// SPDX-License-Identifier: GPL-3.0-or-later
// The whole library on photographs of a textured floor.
#include "densify/densify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/log.h"
#include "densify/floor_fixture.h"
#include "io/openmvs/mvs.h"
#include "io/ply/ply.h"
#include "support/error_of.h"

namespace axial::densify {
namespace {

namespace fs = std::filesystem;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

class Densify : public FloorTest {};

TEST_F(Densify, MakesACloudOnTheSurfaceAndReportsIt) {
  SceneFacts facts{true, true, true};
  const Report report = densify(settings_, [&](const SceneFacts& found) { facts = found; });
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
  EXPECT_EQ(io::read_mvs(settings_.output, settings_.survey.files.working_folder).images.size(),
            4u);
}

TEST_F(Densify, ASecondRunUsesTheDepthMapsOfTheFirst) {
  densify(settings_);
  const auto written = fs::last_write_time(map(2));
  const std::string cloud = read_file(folder_ / "out" / "dense.ply");
  fs::remove(map(1));
  densify(settings_);
  EXPECT_EQ(fs::last_write_time(map(2)), written);
  EXPECT_TRUE(fs::exists(map(1)));
  EXPECT_EQ(read_file(folder_ / "out" / "dense.ply"), cloud);
  settings_.matching.iterations = 1;
  densify(settings_);
  EXPECT_NE(fs::last_write_time(map(2)), written);
}

// The least memory [MB] that these settings need, from the message that refuses less.
std::uint64_t least_memory(Settings settings) {
  settings.survey.memory.megabytes = 1;
  const std::string refusal = test::error_of([&] { densify(settings); });
  const std::string_view before = "this scene needs ";
  const std::size_t at = refusal.find(before);
  EXPECT_NE(at, std::string::npos) << refusal;
  return at == std::string::npos ? 1 : std::stoull(refusal.substr(at + before.size()));
}

// With the least memory, one image at a time is matched, also by several threads: matching an image
// needs more than the megabyte to which the least memory is rounded up.
TEST_F(Densify, ThreadsAndMemoryDoNotChangeTheCloud) {
  densify(settings_);
  const std::string cloud = read_file(folder_ / "out" / "dense.ply");
  use_folder("other");
  const std::uint64_t least = least_memory(settings_);
  settings_.survey.memory.megabytes = least - 1;
  EXPECT_THAT(test::error_of([&] { densify(settings_); }), HasSubstr("are too little"));
  settings_.survey.memory.megabytes = least;
  for (const unsigned threads : {0u, 1u}) {
    use_folder("threads" + std::to_string(threads));
    settings_.max_threads = threads;
    densify(settings_);
    EXPECT_EQ(read_file(settings_.survey.files.working_folder / "dense.ply"), cloud) << threads;
  }
}

TEST_F(Densify, WithoutFusionTheSparsePointsAreTheCloud) {
  settings_.fuse = false;
  settings_.geometric_iterations = 0;
  const Report report = densify(settings_);
  EXPECT_EQ(report.result, Result::sparse_cloud);
  EXPECT_EQ(report.points, points_);
  EXPECT_EQ(io::read_cloud_ply(report.cloud).size(), points_);
  EXPECT_TRUE(fs::exists(map(3)));
}

TEST_F(Densify, ExportsAndListsMakeNoDepthMaps) {
  settings_.export_number_views = 2;
  Report report = densify(settings_);
  EXPECT_EQ(report.result, Result::point_export);
  EXPECT_EQ(report.cloud, folder_ / "out" / "dense_2views.ply");
  EXPECT_EQ(report.points, points_);
  settings_.export_number_views = 0;
  settings_.neighbour_lists_output = folder_ / "lists.txt";
  report = densify(settings_);
  EXPECT_EQ(report.result, Result::neighbour_lists);
  EXPECT_TRUE(report.cloud.empty());
  EXPECT_TRUE(fs::exists(folder_ / "lists.txt"));
  EXPECT_FALSE(fs::exists(map(0)));
}

TEST_F(Densify, RefusesToOverwriteInputs) {
  const std::string scene = read_file(settings_.survey.files.scene);
  settings_.output = settings_.survey.files.scene;
  EXPECT_THAT(test::error_of([&] { densify(settings_); }),
              HasSubstr(settings_.survey.files.scene.string()));
  EXPECT_EQ(read_file(settings_.survey.files.scene), scene);
  use_folder("out");
  settings_.other_inputs = {folder_ / "out" / "dense.ply"};
  write_atomically(settings_.other_inputs.front(), "the caller's");
  EXPECT_THAT(test::error_of([&] { densify(settings_); }), HasSubstr("dense.ply"));
  EXPECT_EQ(read_file(settings_.other_inputs.front()), "the caller's");
}

TEST_F(Densify, ErrorsNameSettingsInTheWordsOfTheCaller) {
  fs::create_directories(folder_ / "no_masks");
  Settings memory = settings_, output = settings_, report = settings_, lists = settings_,
           masks = settings_, housing = settings_, maps = settings_, pinholes = settings_;
  memory.survey.memory.megabytes = 1;
  output.output = settings_.survey.files.scene;
  report.report = settings_.survey.files.scene;
  lists.neighbour_lists_output = settings_.survey.files.scene;
  masks.survey.mask_folder = folder_ / "no_masks";
  masks.survey.ignore_mask_label = 0;
  housing.survey.files.ports = io::PortChoice::required;
  maps.make_maps = false;
  pinholes.pinhole_export = folder_ / "pinholes";
  const std::pair<std::string, Settings*> cases[] = {
      {"max_memory 1: ", &memory},  {"output ", &output},
      {"report ", &report},         {"neighbour_lists_output ", &lists},
      {"mask_folder ", &masks},     {"refractive needs", &housing},
      {"make_maps false: ", &maps}, {"pinhole_export ", &pinholes}};
  for (const auto& [words, settings] : cases) {
    const auto error = [&] { return test::error_of([&] { densify(*settings); }); };
    EXPECT_THAT(error(), AllOf(HasSubstr(words), Not(ContainsRegex("--[a-z]"))));
    settings->survey.files.name_of = [](std::string_view setting) {
      return fmt::format("<{}", setting);
    };
    EXPECT_THAT(error(), HasSubstr("<" + words));
  }
}

TEST_F(Densify, WarningsNameSettingsInTheWordsOfTheCaller) {
  settings_.survey.mask_folder = folder_;
  settings_.neighbour_lists_output = folder_ / "lists.txt";
  const LogCapture log;
  densify(settings_);
  EXPECT_THAT(log.text(), HasSubstr("mask_folder " + folder_.string() +
                                    ": is not used, because ignore_mask_label is -1\n"));
  EXPECT_THAT(log.text(), Not(ContainsRegex("--[a-z]")));
  settings_.survey.files.name_of = [](std::string_view setting) {
    return fmt::format("<{}>", setting);
  };
  densify(settings_);
  EXPECT_THAT(log.text(), HasSubstr("because <ignore_mask_label> is -1\n"));
}

}  // namespace
}  // namespace axial::densify
