// SPDX-License-Identifier: GPL-3.0-or-later
// The images and masks that the import of a COLMAP model undistorts, and the errors of a camera's
// lens. tests/lens/lens_test.cpp compares the lenses themselves with OpenCV.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "io/colmap/colmap_lens.h"
#include "io/colmap/colmap_scene.h"
#include "io/colmap_scene_fixture.h"
#include "io/images/image.h"
#include "support/error_of.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

TEST_F(ColmapScene, UndistortsImagesThatAreNoPinholes) {
  const Scene scene = import_colmap_scene(model_, import_);
  EXPECT_EQ(scene.images[2].path, (import_.undistorted_folder / "c.png").string());
  const cv::Mat3b image = read_color_image(scene.images[2].path);
  ASSERT_EQ(image.size(), cv::Size(kWidth, kHeight));
  const auto& lens = scene.images[2].camera.lens;
  double worst = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const Eigen::Vector2d p = image_direction(lens_of(model_.cameras[1]), (x - lens.cx) / lens.fx,
                                                (y - lens.cy) / lens.fy);
      const cv::Vec3d expected = color_at(p.x(), p.y());
      for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(expected[c] - image(y, x)[c]));
    }
  // Two roundings, and the ripple of the interpolation at the replicated border.
  EXPECT_LT(worst, 3.0);
}

// Images of several cameras in any order are resampled as if each were the only one.
TEST_F(ColmapScene, EachImageIsUndistortedByItsOwnCamera) {
  model_.images.clear();
  model_.points.clear();
  for (std::uint32_t id = 0; id < 6; ++id)
    model_.cameras.push_back(
        {20 + id, "SIMPLE_RADIAL", kWidth, kHeight, {150, 80, 60, -0.02 * (id + 1)}});
  for (std::uint32_t i = 0; i < 18; ++i)
    add_image(i + 1, 20 + i * 5 % 6, fmt::format("{:02}.png", i));
  const Scene scene = import_colmap_scene(model_, import_);
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    const ColmapCamera& camera = model_.cameras[2 + i * 5 % 6];
    cv::Mat3b expected;
    cv::remap(read_color_image(folder_ / "images" / model_.images[i].name), expected,
              undistortion_map(lens_of(camera), scene.images[i].camera.lens), cv::noArray(),
              cv::INTER_LANCZOS4, cv::BORDER_REPLICATE);
    EXPECT_EQ(cv::norm(read_color_image(scene.images[i].path), expected, cv::NORM_INF), 0) << i;
  }
}

TEST_F(ColmapScene, RefusesALensThatTurnsItsImageOver) {
  import_.undistort = false;
  model_.cameras[1] = {
      9, "THIN_PRISM_FISHEYE", kWidth, kHeight, {150, 150, 80, 60, 0, 0, 99, 99, 0, 0, 0, 0}};
  EXPECT_THAT(error(), HasSubstr("camera 9: the distortion of its THIN_PRISM_FISHEYE lens"));
}

TEST_F(ColmapScene, UndistortedImagesStayInTheirFolder) {
  fs::create_directories(folder_ / "images" / "deep");
  model_.images[2].name = "deep/../c.png";
  EXPECT_THAT(error(), HasSubstr("name 'deep/../c.png' is not in the image folder"));
  model_.images[2].name = "c.png";
  import_.undistorted_folder = import_.image_folder;
  EXPECT_THAT(error(), HasSubstr("would be overwritten"));
}

// Names that would be one file on some file system, and the names of the images that do not clash.
TEST_F(ColmapScene, NoTwoImagesAreUndistortedToOneFile) {
  const std::string two = folder_.string() + "/sparse: the images ";
  model_.points.clear();
  const auto error_of = [&](const std::string& first, const std::string& second) {
    model_.images.clear();
    add_image(1, 9, first);
    add_image(2, 9, second);
    return error();
  };
  fs::create_directories(folder_ / "images" / "left");
  for (const auto& [first, second] : std::vector<std::pair<std::string, std::string>>{
           {"a.tif", "a.tif.png"}, {"d.jpg", "d.JPG"}, {"left/e.bmp", "left/E.bmp.png"}}) {
    EXPECT_THAT(error_of(first, second), HasSubstr(two + first + " and " + second + " would"));
    EXPECT_FALSE(fs::exists(import_.undistorted_folder)) << "checked before anything is written";
  }
  EXPECT_EQ(error_of("f.tif", "f.bmp"), "no error");
  EXPECT_EQ(error_of("left/f.png", "f.png"), "no error");
  EXPECT_TRUE(fs::exists(import_.undistorted_folder / "f.tif.png"));
  EXPECT_TRUE(fs::exists(import_.undistorted_folder / "f.bmp.png"));
  // Images that are not undistorted may have any name.
  model_.images.clear();
  add_image(1, 5, "g.tif");
  add_image(2, 5, "g.tif.png");
  EXPECT_EQ(error(), "no error");
}

TEST_F(ColmapScene, PhotographsAreNotUndistortedOver) {
  import_.undistorted_folder = folder_ / "images" / "undistorted";
  fs::create_directories(import_.undistorted_folder);
  add_image(8, 5, "undistorted/c.png");
  EXPECT_THAT(error(), HasSubstr("undistorted/c.png: is an input"));
}

TEST_F(ColmapScene, MasksAreUndistortedWithTheirImages) {
  // Labels equal to the column, so that every pixel of the result tells its origin.
  cv::Mat1w mask(kHeight, kWidth);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) mask(y, x) = static_cast<std::uint16_t>(1000 + x);
  write_png(folder_ / "images" / "c.mask.png", mask);
  write_png(folder_ / "images" / "a.mask.png", mask);
  const Scene scene = import_colmap_scene(model_, import_);
  EXPECT_FALSE(fs::exists(import_.undistorted_folder / "a.mask.png")) << "a.png stays as it is";
  const cv::Mat1w straight = read_label_image(import_.undistorted_folder / "c.mask.png");
  ASSERT_EQ(straight.size(), cv::Size(kWidth, kHeight));
  const auto& lens = scene.images[2].camera.lens;
  double worst = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const Eigen::Vector2d p = image_direction(lens_of(model_.cameras[1]), (x - lens.cx) / lens.fx,
                                                (y - lens.cy) / lens.fy);
      worst = std::max(worst, std::abs(straight(y, x) - 1000 - p.x()));
    }
  EXPECT_LE(worst, 0.5 + 1e-4) << "the nearest pixel's label, never a mixture";
}

TEST_F(ColmapScene, MasksMayBeSmallerThanTheirImages) {
  write_png(folder_ / "images" / "c.mask.png", cv::Mat1b(kHeight / 2, kWidth / 2, 7));
  import_colmap_scene(model_, import_);
  const cv::Mat1w straight = read_label_image(import_.undistorted_folder / "c.mask.png");
  EXPECT_EQ(straight.size(), cv::Size(kWidth, kHeight));
  EXPECT_EQ(cv::countNonZero(straight != 7), 0);
}

TEST_F(ColmapScene, MasksOfAnotherShapeAreRefused) {
  const fs::path mask = folder_ / "images" / "c.mask.png";
  write_png(mask, cv::Mat1b(kHeight, kHeight, 7));
  EXPECT_EQ(error(), mask.string() + ": is 120x120, but its image is 160x120");
  EXPECT_FALSE(fs::exists(import_.undistorted_folder)) << "checked before anything is written";
}

TEST_F(ColmapScene, MasksOfAllNamesAreUndistorted) {
  for (const char* name : {"c.png.png", "c_mask.png", "c.mask.png"}) {
    const fs::path mask = folder_ / "images" / name;
    write_png(mask, cv::Mat1b(kHeight, kWidth, 7));
    fs::remove_all(import_.undistorted_folder);
    import_colmap_scene(model_, import_);
    EXPECT_TRUE(fs::exists(import_.undistorted_folder / "c.mask.png")) << name;
    fs::remove(mask);
  }
}

// Values of 12 bits need 12 bits afterwards too, even at sharp edges.
TEST_F(ColmapScene, WideValuesStayWideWhereImagesAreUndistorted) {
  cv::Mat pixels(kHeight, kWidth, CV_16UC3, cv::Scalar::all(0));
  for (int x = 0; x < kWidth; x += 8) pixels.colRange(x, x + 4).setTo(cv::Scalar::all(4095));
  write_png(folder_ / "images" / "c.png", pixels);
  const Scene scene = import_colmap_scene(model_, import_);
  const Photograph straight = read_photograph(scene.images[2].path);
  EXPECT_EQ(straight.pixels.type(), CV_16UC3);
  EXPECT_EQ(bits_used(straight.pixels), 12);
  EXPECT_TRUE(straight.opaque.empty());
}

TEST_F(ColmapScene, HiddenColorsStayHiddenWhereImagesAreUndistorted) {
  cv::Mat pixels(kHeight, kWidth, CV_8UC4, cv::Scalar(90, 90, 90, 255));
  pixels.colRange(0, kWidth / 2).setTo(cv::Scalar(255, 0, 255, 0));
  fs::remove(folder_ / "images" / "c.png");
  write_png(folder_ / "images" / "c.jpg", pixels);  // a PNG file in spite of its name
  model_.images[2].name = "c.jpg";
  const Scene scene = import_colmap_scene(model_, import_);
  EXPECT_EQ(scene.images[2].path, (import_.undistorted_folder / "c.jpg.png").string());
  const Photograph straight = read_photograph(scene.images[2].path);
  ASSERT_EQ(straight.opaque.size(), cv::Size(kWidth, kHeight));
  int shown = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      if (!straight.opaque(y, x)) continue;
      ++shown;
      EXPECT_EQ(straight.pixels.at<cv::Vec3b>(y, x), cv::Vec3b(90, 90, 90)) << x << " " << y;
    }
  EXPECT_NEAR(shown, kWidth * kHeight / 2, kWidth * kHeight / 10);
}

TEST(ColmapLens, WhatCannotBeUndistortedIsNamed) {
  const auto message = [](const ColmapCamera& camera) {
    return test::error_of([&] { pinhole_inside(camera, "sparse/0"); });
  };
  EXPECT_EQ(message({3, "EQUIRECTANGULAR", 640, 320, {640, 320}}),
            "camera 3: model EQUIRECTANGULAR is not supported; undistort its images with COLMAP "
            "first");
  // COLMAP-Underwater's model, which COLMAP does not know.
  EXPECT_EQ(message({3, "METASHAPE_FISHEYE", 640, 480, {700, 700, 320, 240, 0, 0, 0, 0, 0, 0}}),
            "camera 3: model METASHAPE_FISHEYE is not supported; undistort its images with the "
            "program that calibrated it first");
  // The principal point is outside the image.
  EXPECT_THAT(message({3, "OPENCV_FISHEYE", 640, 480, {700, 700, 900, 240, 0, 0, 0, 0}}),
              HasSubstr("camera 3 (OPENCV_FISHEYE) cannot be undistorted"));
  EXPECT_EQ(message({3, "OPENCV", 640, 480, {700, 700, 320, 240}}),
            "camera 3: model OPENCV has 8 parameters, not 4");
}

}  // namespace
}  // namespace axial::io
