// SPDX-License-Identifier: GPL-3.0-or-later
// Which port of a housing file each image of a scene gets.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/cameras/housing.h"
#include "io/housing_fixture.h"
#include "support/captured_events.h"

namespace axial::io {
namespace {

using test::error_of;
using testing::HasSubstr;

TEST_F(HousingTest, AttachesPortsByTheLongestMatchingName) {
  Housing housing = read(kExample);
  housing.cameras.clear();
  housing.images["a.jpg"] = "main";
  housing.default_port = "none";
  Scene scene;
  for (const char* path : {"/x/left/a.jpg", "/x/right/a.jpg", "/x/b.jpg", "/x/dry_0001.jpg",
                           "y/left/b.jpg", "/x/notleft/aa.jpg"}) {
    scene.images.emplace_back().path = path;
    scene.images.back().port_name = "stale";
  }
  attach_ports(scene, housing, "h.json");
  const std::vector<std::string> expected{"tilted", "main", "", "", "", ""};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(scene.images[i].port_name, expected[i]) << i;
    EXPECT_EQ(scene.images[i].camera.port.has_value(), !expected[i].empty()) << i;
  }
  EXPECT_EQ(flat(*scene.images[0].camera.port).n_water, 1.49);
}

// Images of two cameras have the same base names; an entry may be the end of one name only.
TEST_F(HousingTest, RefusesEntriesThatSeveralImagesGoBy) {
  Housing housing = read(kExample);
  housing.cameras.clear();
  for (int folders = 1; folders <= 3; ++folders)
    for (int images = 1; images <= 3; ++images) {
      Scene scene;
      for (int folder = 0; folder < folders; ++folder)
        for (int image = 0; image < images; ++image)
          scene.images.emplace_back().path = fmt::format("/x/cam{}/{}.jpg", folder, image);
      housing.images = {{"0.jpg", "tilted"}};
      if (folders == 1) {
        attach_ports(scene, housing, "h.json");
        EXPECT_EQ(scene.images[0].port_name, "tilted");
        continue;
      }
      EXPECT_EQ(error_of([&] { attach_ports(scene, housing, "h.json"); }),
                "h.json: housing.images.0.jpg matches /x/cam0/0.jpg and /x/cam1/0.jpg: give more "
                "of the path");
      // All images but one have an entry of their own.
      for (int folder = 1; folder < folders; ++folder)
        housing.images[fmt::format("cam{}/0.jpg", folder)] = "main";
      attach_ports(scene, housing, "h.json");
      for (std::size_t i = 0; i < scene.images.size(); ++i)
        EXPECT_EQ(scene.images[i].port_name, i == 0 ? "tilted" : "main") << i;
    }
}

TEST_F(HousingTest, AnEntryThatIsAWholeNameIsThatImagesAlone) {
  Housing housing = read(kExample);
  housing.default_port = "none";
  housing.cameras = {{7, "main"}};
  housing.images = {{"0.jpg", "tilted"}, {"b/1.jpg", "tilted"}};
  const std::vector<NamedCamera> images{
      {"cam0/0.jpg", 7}, {"0.jpg", 7}, {"cam1/0.jpg", 8}, {"a/b/1.jpg", 7}, {"1.jpg", 7}};
  const Housing found = for_images(housing, images, "h.json");
  const std::vector<std::string> expected{"main", "tilted", "none", "tilted", "main"};
  for (std::size_t i = 0; i < images.size(); ++i)
    EXPECT_EQ(found.port_of(images[i].name, images[i].camera), expected[i]) << images[i].name;
  EXPECT_EQ(for_images(housing, std::vector<NamedCamera>{{"a/b/1.jpg", 7}}, "h.json").images,
            housing.images)
      << "what is clear stays as it is";
  EXPECT_THAT(
      error_of([&] {
        for_images(housing, std::vector<NamedCamera>{{"l/0.jpg", 7}, {"r/0.jpg", 7}}, "h.json");
      }),
      HasSubstr("h.json: housing.images.0.jpg matches l/0.jpg and r/0.jpg"));
}

TEST_F(HousingTest, DoesNotGuessAtCameraIds) {
  const Housing housing = read(kExample);
  Scene scene;
  scene.images.emplace_back().path = "/x/left/a.jpg";
  attach_ports(scene, housing, "h.json");
  scene.images.emplace_back().path = "/x/b.jpg";
  EXPECT_THAT(error_of([&] { attach_ports(scene, housing, "h.json"); }), HasSubstr("/x/b.jpg"));
}

SceneImage looking_down(const std::string& path, double height) {
  SceneImage image;
  image.path = path;
  image.pose.rotation = Eigen::Vector3d(1, -1, -1).asDiagonal();
  image.pose.centre = {1, 2, height};
  return image;
}

TEST_F(HousingTest, GivesEachImageItsPortThroughTheSurface) {
  const Housing housing = read(kLake);
  Scene scene;
  scene.images = {looking_down("/x/low.jpg", 2), looking_down("/x/high.jpg", 30),
                  looking_down("/x/dry.jpg", -3), looking_down("/x/lost.jpg", -3)};
  scene.images[3].calibrated = false;  // its pose is not defined
  attach_ports(scene, housing, "h.json");
  EXPECT_EQ(flat(*scene.images[0].camera.port).distance, 0.5);
  EXPECT_EQ(flat(*scene.images[1].camera.port).distance, 28.5);
  EXPECT_EQ(flat(*scene.images[1].camera.port).normal, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(flat(*scene.images[1].camera.port).thickness, 0);
  EXPECT_EQ(scene.images[1].port_name, "lake");
  EXPECT_FALSE(scene.images[2].camera.port);
  EXPECT_FALSE(scene.images[3].camera.port);

  scene.images.push_back(looking_down("/x/diver.jpg", 1));
  EXPECT_THAT(error_of([&] { attach_ports(scene, housing, "h.json"); }),
              HasSubstr("/x/diver.jpg: its port 'lake': the camera's height over the water surface "
                        "is -0.5 m"));
  scene.images.back() = looking_down("/x/sky.jpg", 3);
  scene.images.back().pose.rotation.setIdentity();
  EXPECT_THAT(error_of([&] { attach_ports(scene, housing, "h.json"); }),
              HasSubstr("/x/sky.jpg: its port 'lake': the camera looks away"));
}

// A drone above the lake and a diver in it: one scene and one housing file.
TEST_F(HousingTest, GivesImagesTheSurfaceOrAPortFromOneFile) {
  const Housing housing = read(R"({ "version": 1, "default": "lake", "ports": {
    "lake": { "type": "water-surface", "normal": [0, 0, -1], "point_m": [0, 0, 1.5],
              "n_water": 1.34 },
    "diver": { "type": "flat", "distance_m": 0.02, "thickness_m": 0.014, "normal": [0.6, 0, 0.8],
               "n_glass": 1.52, "n_water": 1.34 } },
    "images": { "diver/a.jpg": "diver" } })");
  Scene scene;
  scene.images = {looking_down("/x/drone/a.jpg", 6.5), looking_down("/x/diver/a.jpg", -2),
                  looking_down("/x/drone/b.jpg", 9.5)};
  attach_ports(scene, housing, "h.json");
  for (const std::size_t above : {std::size_t{0}, std::size_t{2}}) {
    EXPECT_EQ(scene.images[above].port_name, "lake");
    const auto& port = flat(*scene.images[above].camera.port);
    EXPECT_EQ(port.normal, Eigen::Vector3d::UnitZ());
    EXPECT_EQ(port.distance, above == 0 ? 5 : 8);  // height above the surface
    EXPECT_EQ(port.thickness, 0);
  }
  EXPECT_EQ(scene.images[1].port_name, "diver");
  const auto& port = flat(*scene.images[1].camera.port);
  EXPECT_LT((port.normal - Eigen::Vector3d(0.6, 0, 0.8)).norm(), 1e-15);
  EXPECT_EQ(port.distance, 0.02);
  EXPECT_EQ(port.thickness, 0.014);
}

TEST_F(HousingTest, EveryLineNamesTheFile) {
  Housing housing = read(kExample);
  housing.cameras.clear();
  housing.images = {{"gone.jpg", "main"}};
  Scene scene;
  scene.images.emplace_back().path = "/x/a.jpg";
  test::CapturedEvents log;
  attach_ports(scene, housing, "h.json", log.context);
  EXPECT_THAT(log.lines, HasSubstr("h.json: no image matches images.gone.jpg"));
  housing.cameras = {{1, "main"}};
  EXPECT_THAT(error_of([&] { attach_ports(scene, housing, "h.json"); }),
              testing::StartsWith("h.json: housing.cameras "));
  const Housing lake = read(kLake);
  scene.images = {looking_down("/x/diver.jpg", 1)};
  EXPECT_THAT(error_of([&] { attach_ports(scene, lake, "h.json"); }),
              testing::StartsWith("h.json: /x/diver.jpg: its port 'lake'"));
}

}  // namespace
}  // namespace axial::io
