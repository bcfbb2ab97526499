// SPDX-License-Identifier: GPL-3.0-or-later
// A scene of three images in a folder, of which the second is not calibrated.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <string>

#include "io/images/image.h"
#include "io/openmvs/mvs.h"
#include "support/analytic_scene.h"
#include "support/captured_events.h"
#include "support/empty_folder.h"
#include "support/error_of.h"
#include "survey/survey.h"

namespace axial::test {

namespace fs = std::filesystem;

class SmallSurvey : public testing::Test {
 protected:
  SmallSurvey() {
    Scene scene = scene_of(dry_camera(), circle_of_poses(3));
    for (std::uint32_t i = 0; i < 3; ++i) {
      SceneImage& image = scene.images[i];
      image.path = (folder_ / ("image" + std::to_string(i) + ".png")).string();
      image.id = 10 + i;
      write_photograph("image" + std::to_string(i) + ".png", cv::Vec3b(30, 60, 90));
    }
    scene.images[1].calibrated = false;
    options_.files.scene = folder_ / "scene.mvs";
    options_.files.working_folder = folder_;
    io::write_mvs(options_.files.scene, scene, folder_);
  }

  // Writes a photograph of one colour (B G R), of the size of the cameras.
  void write_photograph(const std::string& name, const cv::Vec3b& color) const {
    io::write_png(folder_ / name, cv::Mat3b(kSize, color));
  }

  // Writes a mask with the label 0 in its left half, and `label` in its right half.
  void write_mask(const std::string& name, std::uint8_t label) const {
    cv::Mat1b mask(kSize, std::uint8_t{0});
    mask.colRange(kSize.width / 2, kSize.width).setTo(label);
    io::write_png(folder_ / name, mask);
  }

  // Of image0.png, the left half has the label to ignore, the upper quarter is transparent, and the
  // right 10 columns are a black border.
  void use_part_of_first_photograph() {
    cv::Mat4b pixels(kSize, cv::Vec4b(30, 60, 90, 255));
    pixels.rowRange(0, kSize.height / 4).setTo(cv::Vec4b(30, 60, 90, 0));
    pixels.colRange(kSize.width - 10, kSize.width).setTo(cv::Vec4b(0, 0, 0, 255));
    io::write_png(folder_ / "image0.png", pixels);
    write_mask("image0.mask.png", 7);
    options_.ignore_mask_label = 0;
    options_.ignore_black_border = true;
  }

  // The survey with its photographs.
  survey::Survey opened() {
    survey::Survey survey = survey::open_scene(options_);
    survey::find_photographs(survey, events_.context);
    return survey;
  }

  std::string error() {
    return error_of([&] { opened(); });
  }

  static inline const cv::Size kSize{dry_camera().width, dry_camera().height};
  const fs::path folder_ = empty_folder();
  survey::Options options_;
  CapturedEvents events_;
};

}  // namespace axial::test
