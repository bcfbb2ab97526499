// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap/colmap_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <opencv2/imgproc.hpp>
#include <random>
#include <set>

#include "base/error.h"
#include "base/log.h"
#include "io/colmap/colmap_lens.h"
#include "io/images/image.h"
#include "support/empty_folder.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr int kWidth = 160, kHeight = 120;

// A smooth picture whose value is known everywhere.
cv::Vec3d color_at(double x, double y) {
  return {128 + 100 * std::sin(x * 0.07), 128 + 100 * std::cos(y * 0.05), 40 + x * 0.5 + y * 0.5};
}

class ColmapScene : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = test::empty_folder();
    fs::create_directories(folder_ / "images");
    import_ = {folder_ / "sparse", folder_ / "images", folder_ / "out" / "undistorted"};
    model_.cameras = {{5, "PINHOLE", kWidth, kHeight, {150, 151, 80, 60}},
                      {9, "SIMPLE_RADIAL", kWidth, kHeight, {150, 80, 60, -0.1}}};
    add_image(4, 5, "b.png");
    add_image(2, 5, "a.png");
    add_image(3, 9, "c.png");
    model_.points.push_back({1, {1, 2, 3}, {10, 20, 30}, 0.5, {{3, 0}, {4, 0}, {2, 0}, {3, 1}}});
  }
  void TearDown() override { fs::remove_all(folder_); }

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

  fs::path folder_;
  ColmapModel model_;
  ColmapImport import_;
};

TEST_F(ColmapScene, TakesImagesPosesAndPointsOver) {
  const Scene scene = import_colmap_scene(model_, import_);
  ASSERT_EQ(scene.images.size(), 3u);
  EXPECT_EQ(scene.images[0].path, (folder_ / "images" / "b.png").string());
  EXPECT_EQ(scene.images[0].id, 3u);  // COLMAP's id minus one
  EXPECT_EQ(scene.images[1].id, 1u);
  EXPECT_EQ(scene.images[0].pose.centre.x(), 4);
  EXPECT_EQ(scene.images[0].camera.lens.cx, 79.5);  // centres at integers
  EXPECT_EQ(scene.images[0].camera.lens.fy, 151);
  EXPECT_FALSE(scene.images[0].camera.port);
  ASSERT_EQ(scene.points.size(), 1u);
  std::vector<std::uint32_t> views;
  for (const SparseView& view : scene.points[0].views) views.push_back(view.image);
  EXPECT_THAT(views, ::testing::ElementsAre(0, 1, 2)) << "each image once";
  EXPECT_EQ(scene.point_colors[0], (Rgb{10, 20, 30}));
}

TEST_F(ColmapScene, ImageIdsThatStartAtZeroDoNotWrap) {
  model_.images[1].id = 0;
  model_.points.clear();
  const Scene scene = import_colmap_scene(model_, import_);
  EXPECT_EQ(scene.images[0].id, 4u);
  EXPECT_EQ(scene.images[1].id, 0u);
}

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

TEST_F(ColmapScene, KeepsImagesAndLensesAsTheyAre) {
  import_.undistort = false;
  ColmapCamera other{11, "RAD_TAN_THIN_PRISM_FISHEYE", kWidth, kHeight, {150, 150, 80, 60}};
  other.params.resize(16, 1e-3);
  model_.cameras.push_back(other);
  add_image(8, 11, "d.png");
  const Scene scene = import_colmap_scene(model_, import_);
  EXPECT_FALSE(scene.images[0].camera.distortion);
  EXPECT_EQ(scene.images[2].path, (folder_ / "images" / "c.png").string());
  ASSERT_TRUE(scene.images[2].camera.distortion);
  EXPECT_EQ(scene.images[2].camera.distortion->above[1], -0.1);
  EXPECT_EQ(scene.images[2].camera.lens.fx, 150);
  EXPECT_EQ(scene.images[2].camera.lens.cx, 79.5);
  // A model that the matcher does not support.
  EXPECT_EQ(scene.images[3].path, (import_.undistorted_folder / "d.png").string());
  EXPECT_FALSE(scene.images[3].camera.distortion);
}

TEST_F(ColmapScene, RefusesALensThatTurnsItsImageOver) {
  import_.undistort = false;
  model_.cameras[1] = {
      9, "THIN_PRISM_FISHEYE", kWidth, kHeight, {150, 150, 80, 60, 0, 0, 99, 99, 0, 0, 0, 0}};
  EXPECT_THAT(error(), HasSubstr("camera 9: the distortion of its THIN_PRISM_FISHEYE lens"));
}

TEST_F(ColmapScene, NamesTheImageThatDoesNotFit) {
  write_png(folder_ / "images" / "a.png", cv::Mat3b(100, 200));
  EXPECT_EQ(error(), (folder_ / "images" / "a.png").string() +
                         ": image is 200 x 100, but its camera is 160 x 120");
  fs::remove(folder_ / "images" / "a.png");
  EXPECT_THAT(error(), HasSubstr("a.png"));
  EXPECT_FALSE(fs::exists(import_.undistorted_folder)) << "checked before anything is written";
}

TEST_F(ColmapScene, UndistortedImagesStayInTheirFolder) {
  fs::create_directories(folder_ / "images" / "deep");
  model_.images[2].name = "deep/../c.png";
  EXPECT_THAT(error(), HasSubstr("name 'deep/../c.png' is not in the image folder"));
  model_.images[2].name = "c.png";
  import_.undistorted_folder = import_.image_folder;
  EXPECT_THAT(error(), HasSubstr("would be overwritten"));
}

// For any track, each image counts once, and one line reports the repetitions.
TEST_F(ColmapScene, ImagesCountOncePerPoint) {
  std::mt19937 random(3);
  model_.points.clear();
  std::size_t repeated = 0;
  std::vector<std::set<std::uint32_t>> expected;
  for (std::uint64_t id = 0; id < 200; ++id) {
    ColmapPoint3D point{id, {0, 0, 1}, {}, 0, {}};
    std::set<std::uint32_t> images;
    for (auto k = std::uint32_t(random() % 6); k-- > 0;) {
      point.track.push_back({std::uint32_t(2 + random() % 3), k});
      repeated += images.insert(point.track.back().image).second ? 0 : 1;
    }
    expected.push_back(images);
    model_.points.push_back(point);
  }
  const LogCapture log;
  const Scene scene = import_colmap_scene(model_, import_);
  EXPECT_THAT(log.text(), HasSubstr(fmt::format(": {} observations are ignored", repeated)));
  for (std::size_t i = 0; i < expected.size(); ++i) {
    std::set<std::uint32_t> images;
    for (const SparseView& view : scene.points[i].views)
      images.insert(model_.images[view.image].id);
    EXPECT_EQ(images, expected[i]);
    EXPECT_EQ(scene.points[i].views.size(), expected[i].size());
  }
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

TEST_F(ColmapScene, PortsGoByTheUndistortedName) {
  model_.points.clear();
  model_.images.clear();
  add_image(1, 9, "a.tif");
  add_image(2, 9, "a.bmp");
  Housing housing;
  housing.ports["main"] = {};
  housing.images = {{"a.tif", "main"}};
  const Scene scene = import_colmap_scene(model_, import_);
  EXPECT_EQ(housing_by_image(housing, model_, scene, import_).images,
            (std::map<std::string, std::string>{{"a.tif.png", "main"}}));
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

TEST_F(ColmapScene, SaysHowManyCamerasAreReady) {
  std::vector<std::size_t> done;
  import_colmap_scene(model_, import_, {}, [&](std::size_t n, std::size_t total) {
    done.push_back(n);
    EXPECT_EQ(total, 2u);
  });
  EXPECT_THAT(done, ::testing::ElementsAre(1, 2));
}

TEST_F(ColmapScene, OneImageIsNotEnough) {
  model_.images.resize(1);
  EXPECT_THAT(error(), HasSubstr("1 registered images, at least 2"));
}

TEST_F(ColmapScene, HousingsAreResolvedToImages) {
  model_.images[0].name = "left/b.png";
  fs::create_directories(folder_ / "images" / "left");
  fs::rename(folder_ / "images" / "b.png", folder_ / "images" / "left" / "b.png");
  model_.images[2].name = "c.jpg";
  fs::rename(folder_ / "images" / "c.png", folder_ / "images" / "c.jpg");
  Housing housing;
  housing.ports["main"] = {};
  housing.ports["other"] = {};
  housing.default_port = "main";
  housing.cameras = {{9, "other"}, {77, "main"}};
  housing.images = {{"b.png", "none"}, {"absent.png", "other"}};
  const Scene scene = import_colmap_scene(model_, import_);
  const Housing resolved = housing_by_image(housing, model_, scene, import_);
  EXPECT_EQ(resolved.default_port, "main");
  EXPECT_TRUE(resolved.cameras.empty());
  EXPECT_EQ(resolved.images,
            (std::map<std::string, std::string>{{"left/b.png", "none"}, {"c.jpg", "other"}}));
  EXPECT_THAT(unused_entries(housing, model_),
              ::testing::ElementsAre("images.absent.png", "cameras.77"));
}

// The housing by names gives the right ports by paths: "0000.png" is the end of other names.
TEST_F(ColmapScene, ShortNamesOfOthersDoNotTakeTheDefaultAway) {
  fs::create_directories(folder_ / "images" / "wet");
  model_ = {};
  model_.cameras = {{5, "PINHOLE", kWidth, kHeight, {150, 151, 80, 60}}};
  add_image(1, 5, "0000.png");
  add_image(2, 5, "wet/0000.png");
  add_image(3, 5, "wet/0002.png");
  Housing housing;
  housing.ports["main"] = {};
  housing.default_port = "main";
  housing.images = {{"wet/0000.png", "main"}, {"0000.png", "none"}};
  Scene scene = import_colmap_scene(model_, import_);
  const Housing resolved = housing_by_image(housing, model_, scene, import_);
  attach_ports(scene, resolved, "h.json");
  EXPECT_EQ(scene.images[0].port_name, "");
  EXPECT_EQ(scene.images[1].port_name, "main");
  EXPECT_EQ(scene.images[2].port_name, "main");
  EXPECT_FALSE(resolved.images.contains("wet/0002.png")) << "no entry that says nothing";
}

TEST_F(ColmapScene, ImagesThatNamesCannotTellApartAreRefused) {
  import_.image_folder = folder_ / "images" / "wet";
  fs::create_directories(import_.image_folder / "wet");
  model_ = {};
  model_.cameras = {{5, "PINHOLE", kWidth, kHeight, {150, 151, 80, 60}}};
  add_image(1, 5, "wet/0000.png");
  add_image(2, 5, "wet/wet/0000.png");
  model_.images[0].name = "0000.png";
  model_.images[1].name = "wet/0000.png";
  Housing housing;
  housing.ports["main"] = {};
  housing.images = {{"wet/0000.png", "main"}};
  const Scene scene = import_colmap_scene(model_, import_);
  try {
    housing_by_image(housing, model_, scene, import_);
    ADD_FAILURE() << "no error";
  } catch (const Error& caught) {
    EXPECT_THAT(caught.what(), HasSubstr("wet/0000.png: its port is 'none', but"));
  }
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

}  // namespace
}  // namespace axial::io
