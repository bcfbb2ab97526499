// SPDX-License-Identifier: GPL-3.0-or-later
// Photographs of a textured floor, ready for densify(), for tests of the whole library.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <string>

#include "axial/densify.h"
#include "io/images/image.h"
#include "io/openmvs/mvs.h"
#include "scene/scene.h"
#include "support/empty_folder.h"
#include "support/error_of.h"
#include "support/textured_scene.h"

namespace axial::densify {

inline CameraModel floor_camera() {
  CameraModel model;
  model.width = 160;
  model.height = 120;
  model.lens = {150, 150, 79.5, 59.5};
  return model;
}

// Four cameras in a row, and sparse points that the first sees.
class FloorTest : public testing::Test {
 protected:
  FloorTest() {
    Scene scene;
    for (int i = 0; i < 4; ++i) {
      SceneImage image;
      image.path = (folder_ / ("image" + std::to_string(i) + ".png")).string();
      image.id = static_cast<std::uint32_t>(i);
      image.camera = floor_camera();
      image.pose.centre = {0.25 * (i % 2), 0.25 * (i / 2), 0};
      const cv::Mat1b grey = test::render(floor_, image.camera, image.pose).image;
      cv::Mat3b color;
      cv::cvtColor(grey, color, cv::COLOR_GRAY2BGR);
      io::write_png(image.path, color);
      scene.images.push_back(image);
    }
    for (int y = 4; y < 120; y += 7)
      for (int x = 4; x < 160; x += 7) add_point(scene, x, y);
    points_ = scene.points.size();
    options_.survey.files.scene = folder_ / "scene.mvs";
    io::write_mvs(options_.survey.files.scene, scene, folder_);
    use_folder("out");
  }

  // The point of the floor at a pixel of the first image, if two images see it.
  void add_point(Scene& scene, int x, int y) const {
    const Eigen::Vector3d direction = Eigen::Vector3d((x - 79.5) / 150, (y - 59.5) / 150, 1);
    const Eigen::Vector3d unit = direction.normalized();
    SparsePoint point;
    point.position = (floor_.depth(Eigen::Vector3d::Zero(), unit) * unit).cast<float>();
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Eigen::Vector3d at = scene.images[i].pose.to_camera(point.position.cast<double>());
      const double u = 150 * at.x() / at.z() + 79.5, v = 150 * at.y() / at.z() + 59.5;
      if (u >= 0 && u <= 159 && v >= 0 && v <= 119) point.views.push_back({i, 0});
    }
    if (point.views.size() > 1) scene.points.push_back(point);
  }

  void use_folder(const std::string& name) {
    options_.survey.files.working_folder = folder_ / name;
    options_.output.scene = folder_ / name / "dense.mvs";
    std::filesystem::create_directories(options_.survey.files.working_folder);
  }

  static Context with_memory(std::uint64_t megabytes, std::optional<unsigned> threads = {}) {
    return Context({}, {}, {MemoryBudget::of_program(megabytes), threads});
  }

  // The least memory [MB] that a run needs, from the message that refuses less.
  static std::uint64_t least_memory(const Options& options) {
    const std::string refusal = test::error_of([&] { densify(options, {}, with_memory(1)); });
    const std::string before = "this scene needs ";
    const std::size_t at = refusal.find(before);
    EXPECT_NE(at, std::string::npos) << refusal;
    return at == std::string::npos ? 1 : std::stoull(refusal.substr(at + before.size()));
  }

  std::filesystem::path map(int image) const {
    return options_.survey.files.working_folder / ("depth000" + std::to_string(image) + ".dmap");
  }

  const test::TexturedScene floor_{.cell = 0.04};  // three pixels
  const std::filesystem::path folder_ = test::empty_folder();
  std::size_t points_ = 0;
  Options options_;
};

}  // namespace axial::densify
