// SPDX-License-Identifier: GPL-3.0-or-later
// The run from a survey in memory gives what the run from files gives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <stop_token>
#include <variant>

#include "axial/densify.h"
#include "densify/floor_fixture.h"
#include "io/cameras/housing.h"
#include "io/openmvs/dmap.h"
#include "io/ply/ply.h"
#include "support/error_of.h"

namespace axial::densify {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class MemoryRun : public FloorTest {
 protected:
  // The survey of the fixture's files.
  survey::MemorySurvey survey_in_memory() const {
    survey::MemorySurvey survey;
    survey.scene = io::read_mvs(options_.survey.files.scene, folder_);
    survey.read = [scene = survey.scene](std::size_t image) {
      return io::read_photograph(scene.images[image].path);
    };
    return survey;
  }

  // The options of a run without folders.
  Options without_files() const {
    Options options = options_;
    options.survey.files = {};
    options.output.scene.clear();
    return options;
  }
};

TEST_F(MemoryRun, GivesTheMapsAndTheCloudOfFiles) {
  densify(options_);
  Options options = without_files();
  std::map<std::size_t, DepthMap> maps;
  options.output.take_map = [&](std::size_t image, DepthMap map) { maps[image] = std::move(map); };
  use_folder("temporary");
  const char* const stated = std::getenv("TMPDIR");
  const std::string before = stated ? stated : "";
  ASSERT_EQ(setenv("TMPDIR", (folder_ / "temporary").c_str(), 1), 0);
  const MemoryResult result = densify(survey_in_memory(), options);
  ASSERT_EQ(before.empty() ? unsetenv("TMPDIR") : setenv("TMPDIR", before.c_str(), 1), 0);
  EXPECT_TRUE(fs::is_empty(folder_ / "temporary"));
  EXPECT_TRUE(result.report.cloud.empty());
  EXPECT_TRUE(result.frame.is_world());
  const PointCloud cloud = io::read_cloud_ply(folder_ / "out" / "dense.ply");
  EXPECT_EQ(result.cloud.positions, cloud.positions);
  EXPECT_EQ(result.cloud.colors, cloud.colors);
  ASSERT_EQ(maps.size(), 4u);
  for (const auto& [image, map] : maps) {
    const DepthMap file =
        io::read_dmap(folder_ / "out" / ("depth000" + std::to_string(image) + ".dmap")).map;
    EXPECT_EQ(cv::norm(map.depth, file.depth, cv::NORM_INF), 0) << image;
    EXPECT_EQ(fs::path(map.image_path).filename(), fs::path(file.image_path).filename());
  }
}

TEST_F(MemoryRun, ContinuesInAWorkingFolderAndWritesTheHousing) {
  survey::MemorySurvey survey = survey_in_memory();
  refractive::FlatPort<double> port;
  port.distance = 0.01;
  port.n_glass = 1.5;
  port.n_water = 1.333;
  for (SceneImage& image : survey.scene.images) image.camera.port = port;
  std::stop_source source;
  const Context stopping(
      [&](const Event& event) {
        if (event.text == "Estimated depth maps" && event.done == 2) source.request_stop();
      },
      source.get_token(), {{}, 1});
  use_folder("work");
  EXPECT_THROW(densify(survey, options_, stopping), Stopped);
  std::string lines;
  const MemoryResult result =
      densify(survey, options_, Context([&](const Event& event) { lines += event.text + "\n"; }));
  // The third map is stopped while it is made.
  EXPECT_THAT(lines, HasSubstr("Estimated depth maps: 2 maps existed already"));
  EXPECT_EQ(result.report.cloud, folder_ / "work" / "dense.ply");
  const io::Housing housing = io::read_housing(folder_ / "work" / "dense.housing.json");
  ASSERT_EQ(housing.ports.size(), 1u);
  EXPECT_EQ(std::get<refractive::FlatPort<double>>(housing.ports.begin()->second), port);
}

TEST_F(MemoryRun, LeavesOutMaskedPixels) {
  survey::MemorySurvey survey = survey_in_memory();
  survey.has_masks = true;
  survey.read = [read = survey.read](std::size_t image) {
    io::Photograph photograph = read(image);
    photograph.opaque = cv::Mat1b(photograph.pixels.size(), 255);
    photograph.opaque.colRange(0, 40) = 0;
    return photograph;
  };
  Options options = without_files();
  std::size_t maps = 0;
  options.output.take_map = [&](std::size_t, DepthMap map) {
    ++maps;
    EXPECT_EQ(cv::countNonZero(map.depth.colRange(0, 40)), 0);
    EXPECT_GT(cv::countNonZero(map.depth.colRange(60, 120)), 1000);
  };
  densify(survey, options);
  EXPECT_EQ(maps, 4u);
}

TEST_F(MemoryRun, RefusesAWrongSurvey) {
  const auto refusal = [&](auto change) {
    survey::MemorySurvey survey = survey_in_memory();
    change(survey);
    return test::error_of([&] { densify(survey, without_files()); });
  };
  using Survey = survey::MemorySurvey;
  EXPECT_THAT(refusal([](Survey& s) { s.read = {}; }), HasSubstr("read: is empty"));
  EXPECT_THAT(refusal([](Survey& s) {
                for (SceneImage& image : s.scene.images) image.calibrated = false;
              }),
              HasSubstr("images: none of 4 images is calibrated"));
  EXPECT_THAT(refusal([](Survey& s) { s.scene.images[2].path = s.scene.images[0].path; }),
              HasSubstr("images[2].path '"));
  EXPECT_THAT(refusal([](Survey& s) { s.scene.images[1].camera.width = 0; }),
              HasSubstr("images[1].camera.width 0: must be above 0"));
  EXPECT_THAT(refusal([](Survey& s) { s.scene.images[1].camera.lens.fx = -1; }),
              HasSubstr("images[1].camera.lens.fx -1: must be above 0"));
  EXPECT_THAT(refusal([](Survey& s) { s.scene.images[3].pose.rotation *= 2; }),
              HasSubstr("images[3].pose.rotation is not a rotation"));
  EXPECT_THAT(refusal([](Survey& s) { s.scene.images[3].pose.centre.x() = std::nan(""); }),
              HasSubstr("images[3].pose.centre"));
  EXPECT_THAT(
      refusal([](Survey& s) { s.scene.images[0].camera.port.emplace().emplace<0>().n_water = 9; }),
      HasSubstr("images[0].camera.port"));
  EXPECT_THAT(refusal([](Survey& s) { s.scene.points[5].views[0].image = 4; }),
              HasSubstr("points[5] has a view of image 4, but the scene has 4 images"));
  EXPECT_THAT(refusal([](Survey& s) {
                s.read = [](std::size_t) { return io::Photograph{cv::Mat3b(10, 10), {}}; };
              }),
              HasSubstr("the photograph is not of 160 x 120 pixels"));
}

TEST_F(MemoryRun, RefusesOptionsThatNeedFiles) {
  Options options = without_files();
  options.job = TileJob();
  EXPECT_THAT(test::error_of([&] { densify(survey_in_memory(), options); }), HasSubstr("job: "));
  options = without_files();
  options.output.pinhole_export = folder_ / "export";
  EXPECT_THAT(test::error_of([&] { densify(survey_in_memory(), options); }),
              HasSubstr("pinhole_export "));
  options = without_files();
  options.fusion.tiles = 0;
  EXPECT_THAT(test::error_of([&] { densify(survey_in_memory(), options); }),
              HasSubstr("tiles 0: must be from 1 to"));
}

}  // namespace
}  // namespace axial::densify
