// SPDX-License-Identifier: GPL-3.0-or-later
// A COLMAP model with three photographs, for the tests of its import and of its undistortion.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "base/error.h"
#include "io/colmap/colmap_scene.h"
#include "io/images/image.h"
#include "support/empty_folder.h"

namespace axial::io {

inline constexpr int kWidth = 160, kHeight = 120;

// The colour of the photographs at the position (x, y) [px], as a formula, so that it is also known
// between pixels.
inline cv::Vec3d color_at(double x, double y) {
  return {128 + 100 * std::sin(x * 0.07), 128 + 100 * std::cos(y * 0.05), 40 + x * 0.5 + y * 0.5};
}

class ColmapScene : public test::FolderTest {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "images");
    import_ = {folder_ / "sparse", folder_ / "images", folder_ / "out" / "undistorted"};
    model_.cameras = {{5, "PINHOLE", kWidth, kHeight, {150, 151, 80, 60}},
                      {9, "SIMPLE_RADIAL", kWidth, kHeight, {150, 80, 60, -0.1}}};
    add_image(4, 5, "b.png");
    add_image(2, 5, "a.png");
    add_image(3, 9, "c.png");
    model_.points.push_back({1, {1, 2, 3}, {10, 20, 30}, 0.5, {{3, 0}, {4, 0}, {2, 0}, {3, 1}}});
  }

  void add_image(std::uint32_t id, std::uint32_t camera, const std::string& name) {
    ColmapImage image;
    image.id = id;
    image.camera = camera;
    image.name = name;
    image.pose.centre = {double(id), 0, 0};
    model_.images.push_back(image);
    cv::Mat3b pixels(kHeight, kWidth);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) pixels(y, x) = color_at(x, y);
    write_png(folder_ / "images" / name, pixels);
  }

  std::string error() const {
    try {
      import_colmap_scene(model_, import_);
    } catch (const Error& caught) {
      return caught.what();
    }
    return "no error";
  }

  ColmapModel model_;
  ColmapImport import_;
};

}  // namespace axial::io
