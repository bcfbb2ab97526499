// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap/colmap_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "io/colmap_scene_fixture.h"
#include "io/images/image.h"
#include "support/captured_events.h"
#include "support/error_of.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

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

TEST_F(ColmapScene, MissingImagesAreLeftOutWithTheirObservations) {
  EXPECT_TRUE(remove_missing_images(model_, import_.image_folder).empty());
  model_.points.push_back({2, {4, 5, 6}, {}, 0.5, {{3, 2}, {4, 1}}});
  for (ColmapImage& image : model_.images) image.points = {{1, 1, 1}, {2, 2, 2}};
  fs::remove(folder_ / "images" / "c.png");  // the image with the id 3
  EXPECT_THAT(remove_missing_images(model_, import_.image_folder),
              ::testing::ElementsAre(folder_ / "images" / "c.png"));
  ASSERT_EQ(model_.images.size(), 2u);
  ASSERT_EQ(model_.points.size(), 1u) << "one observation is left of the other point";
  EXPECT_EQ(model_.points[0].track.size(), 2u);
  for (const ColmapImage& image : model_.images) {
    EXPECT_EQ(image.points[0].point3d, 1u);
    EXPECT_EQ(image.points[1].point3d, kNoPoint3D);
  }
  EXPECT_EQ(import_colmap_scene(model_, import_).images.size(), 2u);
}

TEST_F(ColmapScene, ImageIdsThatStartAtZeroDoNotWrap) {
  model_.images[1].id = 0;
  model_.points.clear();
  const Scene scene = import_colmap_scene(model_, import_);
  EXPECT_EQ(scene.images[0].id, 4u);
  EXPECT_EQ(scene.images[1].id, 0u);
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

TEST_F(ColmapScene, NamesTheImageThatDoesNotFit) {
  write_png(folder_ / "images" / "a.png", cv::Mat3b(100, 200));
  EXPECT_EQ(error(), (folder_ / "images" / "a.png").string() +
                         ": image is 200 x 100, but its camera is 160 x 120");
  fs::remove(folder_ / "images" / "a.png");
  EXPECT_THAT(error(), HasSubstr("a.png"));
  EXPECT_FALSE(fs::exists(import_.undistorted_folder)) << "checked before anything is written";
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
  test::CapturedEvents log;
  const Scene scene = import_colmap_scene(model_, import_, {}, {}, {}, log.context);
  EXPECT_THAT(log.lines, HasSubstr(fmt::format(": {} observations are ignored", repeated)));
  for (std::size_t i = 0; i < expected.size(); ++i) {
    std::set<std::uint32_t> images;
    for (const SparseView& view : scene.points[i].views)
      images.insert(model_.images[view.image].id);
    EXPECT_EQ(images, expected[i]);
    EXPECT_EQ(scene.points[i].views.size(), expected[i].size());
  }
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
  EXPECT_THAT(test::error_of([&] { housing_by_image(housing, model_, scene, import_); }),
              HasSubstr("wet/0000.png: its port is 'none', but"));
}

}  // namespace
}  // namespace axial::io
