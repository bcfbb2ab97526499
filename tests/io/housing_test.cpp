// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/housing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/atomic_file.h"
#include "base/log.h"
#include "io/wrong_input.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using testing::HasSubstr;

const std::string kExample = R"({ "version": 1,
  "ports": {
    "main": { "type": "flat", "distance_m": 0.020, "thickness_m": 0.014, "normal": [0, 0, 1],
              "n_air": 1.0, "n_glass": 1.52, "n_water": 1.333 },
    "tilted": { "type": "flat", "distance_m": 0, "thickness_m": 0.5, "normal": [0.3, 0, 1],
                "n_glass": 1.33, "n_water": 1.49 } },
  "default": "main",
  "cameras": { "2": "tilted" },
  "images": { "dry_0001.jpg": "none", "left/a.jpg": "tilted" } }
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

auto& flat(auto& port) {
  return std::get<refractive::FlatPort<double>>(port);
}

class HousingTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = test::empty_folder();
    file_ = folder_ / "scene.housing.json";
  }
  void TearDown() override { fs::remove_all(folder_); }

  Housing read(const std::string& text) {
    test::put(file_, text);
    return read_housing(file_);
  }
  // The error for the example with `from` replaced by `to`.
  std::string error(const std::string& from, const std::string& to) {
    const std::string message = error_of([&] { read(replaced(kExample, from, to)); });
    EXPECT_THAT(message, HasSubstr(file_.string()));
    return message;
  }

  fs::path folder_, file_;
};

TEST_F(HousingTest, ReadsTheExample) {
  const Housing housing = read(kExample);
  ASSERT_EQ(housing.ports.size(), 2u);
  const auto& main = flat(housing.ports.at("main"));
  EXPECT_EQ(main.distance, 0.02);
  EXPECT_EQ(main.thickness, 0.014);
  EXPECT_EQ(main.n_glass, 1.52);
  EXPECT_EQ(main.n_water, 1.333);
  EXPECT_EQ(main.normal, Eigen::Vector3d(0, 0, 1));
  const auto& tilted = flat(housing.ports.at("tilted"));
  EXPECT_EQ(tilted.n_air, 1);
  EXPECT_NEAR(tilted.normal.norm(), 1, 1e-15);
  EXPECT_NEAR(tilted.normal.x() / tilted.normal.z(), 0.3, 1e-15);
  EXPECT_EQ(housing.port_of("dry_0001.jpg", 2), "none");
  EXPECT_EQ(housing.port_of("other.jpg", 2), "tilted");
  EXPECT_EQ(housing.port_of("other.jpg", 1), "main");
}

TEST_F(HousingTest, ReadsBackWhatItWrites) {
  Housing housing = read(kExample);
  flat(housing.ports["main"]).normal = Eigen::Vector3d(0.01, -0.02, 1).normalized();
  write_housing(file_, housing);
  const Housing again = read_housing(file_);
  EXPECT_EQ(again.default_port, housing.default_port);
  EXPECT_EQ(again.cameras, housing.cameras);
  EXPECT_EQ(again.images, housing.images);
  for (const auto& [name, port] : housing.ports) {
    EXPECT_EQ(flat(again.ports.at(name)).distance, flat(port).distance);
    EXPECT_EQ(flat(again.ports.at(name)).n_glass, flat(port).n_glass);
    EXPECT_LT((flat(again.ports.at(name)).normal - flat(port).normal).norm(), 1e-15);
  }
  const std::string bytes = read_file(file_);
  write_housing(file_, again);
  EXPECT_EQ(read_file(file_), bytes);
}

constexpr const char* kDome = R"({ "version": 1, "default": "main", "ports": { "main":
  { "type": "dome", "center_m": [0.001, 0, -0.002], "inner_radius_m": 0.05, "thickness_m": 0.007,
    "n_glass": 1.49, "n_water": 1.34 } } })";

TEST_F(HousingTest, ReadsAndWritesDomes) {
  Housing housing = read(kDome);
  for (int turn = 0; turn < 2; ++turn) {
    const auto& dome = std::get<refractive::DomePort<double>>(housing.ports.at("main"));
    EXPECT_EQ(dome.centre, Eigen::Vector3d(0.001, 0, -0.002));
    EXPECT_EQ(dome.inner_radius, 0.05);
    EXPECT_EQ(dome.thickness, 0.007);
    EXPECT_EQ(dome.n_air, 1);
    EXPECT_EQ(dome.n_glass, 1.49);
    EXPECT_EQ(dome.n_water, 1.34);
    write_housing(file_, housing);
    housing = read_housing(file_);
  }
}

TEST_F(HousingTest, NamesKeyAndValueOfDomes) {
  const auto error = [&](const std::string& from, const std::string& to) {
    return error_of([&] { read(replaced(kDome, from, to)); });
  };
  EXPECT_THAT(error("0.05", "50"), HasSubstr("main.inner_radius_m is 50"));
  EXPECT_THAT(error("-0.002]", "0.05]"), HasSubstr("main.center_m is 0.05"));
  EXPECT_THAT(error("-0.002]", "null]"), HasSubstr("main.center_m"));
  EXPECT_THAT(error("-0.002]", "1, 2]"), HasSubstr("three numbers"));
  EXPECT_THAT(error("\"inner_radius_m\": 0.05,", ""), HasSubstr("'inner_radius_m' is missing"));
  EXPECT_THAT(error("\"n_glass\"", "\"normal\""), HasSubstr("'normal'"));
  EXPECT_THAT(error("1.34", "0.5"), HasSubstr("n_water is 0.5"));
}

constexpr const char* kLake = R"({ "version": 1, "default": "lake", "ports": { "lake":
  { "type": "water-surface", "normal": [0, 0, -1], "point_m": [7, 8, 1.5], "n_water": 1.34 } },
  "images": { "dry.jpg": "none" } })";

TEST_F(HousingTest, ReadsAndWritesWaterSurfaces) {
  Housing housing = read(kLake);
  for (int turn = 0; turn < 2; ++turn) {
    const auto& lake = std::get<WaterSurface>(housing.ports.at("lake"));
    EXPECT_EQ(lake.normal, Eigen::Vector3d(0, 0, -1));
    EXPECT_EQ(lake.point, Eigen::Vector3d(7, 8, 1.5));
    EXPECT_EQ(lake.n_air, 1);
    EXPECT_EQ(lake.n_water, 1.34);
    write_housing(file_, housing);
    housing = read_housing(file_);
  }
  const Housing tilted = read(replaced(kLake, "[0, 0, -1]", "[0.3, 0, -1]"));
  const auto& normal = std::get<WaterSurface>(tilted.ports.at("lake")).normal;
  EXPECT_NEAR(normal.norm(), 1, 1e-15);
  EXPECT_NEAR(normal.x() / normal.z(), -0.3, 1e-15);
  EXPECT_THAT(error_of([&] { refuse_water_surfaces(housing, file_); }),
              HasSubstr(file_.string() + ": housing.ports.lake is a water surface"));
  EXPECT_THAT(error_of([&] { (void)housing.carried_port("lake"); }), HasSubstr("'lake'"));
  EXPECT_EQ(housing.carried_port("none"), std::nullopt);
}

TEST_F(HousingTest, NamesKeyAndValueOfWaterSurfaces) {
  const auto error = [&](const std::string& from, const std::string& to) {
    const std::string message = error_of([&] { read(replaced(kLake, from, to)); });
    EXPECT_THAT(message, HasSubstr(file_.string()));
    return message;
  };
  EXPECT_THAT(error("[0, 0, -1]", "[0, 0, 0]"), HasSubstr("lake.normal is [0,0,0]"));
  EXPECT_THAT(error("[0, 0, -1]", "[0, 0]"), HasSubstr("lake.normal is [0,0], expected three"));
  EXPECT_THAT(error("\"normal\": [0, 0, -1],", ""), HasSubstr("'normal' is missing"));
  EXPECT_THAT(error("[7, 8, 1.5]", "1.5"), HasSubstr("lake.point_m is 1.5"));
  EXPECT_THAT(error("[7, 8, 1.5]", "[7, 8, \"up\"]"), HasSubstr("three numbers"));
  EXPECT_THAT(error("[7, 8, 1.5]", "[7, 8, 1e400]"), HasSubstr("JSON"));
  EXPECT_THAT(error("\"point_m\": [7, 8, 1.5],", ""), HasSubstr("'point_m' is missing"));
  EXPECT_THAT(error("\"point_m\"", "\"point\""), HasSubstr("unknown key 'point'"));
  EXPECT_THAT(error("1.34", "0.5"), HasSubstr("lake.n_water is 0.5"));
  EXPECT_THAT(error("1.34", "\"wet\""), HasSubstr("lake.n_water is \"wet\""));
  EXPECT_THAT(error(", \"n_water\": 1.34", ""), HasSubstr("'n_water' is missing"));
  EXPECT_THAT(error("1.34", "1.34, \"n_air\": 1.5"), HasSubstr("lake.n_air is 1.5"));
  EXPECT_THAT(error("1.34", "1.34, \"n_glass\": 1.5"), HasSubstr("unknown key 'n_glass'"));
  EXPECT_THAT(error("1.34", "1.34, \"thickness_m\": 0"), HasSubstr("'thickness_m'"));
  EXPECT_THAT(error("water-surface", "water surface"), HasSubstr("'water-surface'"));
}

TEST_F(HousingTest, RefusesToWriteImpossibleWaterSurfaces) {
  const auto error = [&](const WaterSurface& surface) {
    Housing housing;
    housing.ports["lake"] = surface;
    return error_of([&] { write_housing(file_, housing); });
  };
  EXPECT_THAT(error({{0, 0, -2}, {0, 0, 0}, 1, 1.33}), HasSubstr("lake.normal has length 2"));
  EXPECT_THAT(error({{0, 0, -1}, {0, std::nan(""), 0}, 1, 1.33}), HasSubstr("lake.point_m"));
  EXPECT_THAT(error({{0, 0, -1}, {0, 0, 0}, 1, 0.9}), HasSubstr("lake.n_water is 0.9"));
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

TEST_F(HousingTest, NamesKeyAndValue) {
  EXPECT_THAT(error("\"version\": 1", "\"version\": 2"), HasSubstr("version is 2"));
  EXPECT_THAT(error("\"version\": 1,", ""), HasSubstr("'version' is missing"));
  EXPECT_THAT(error("\"default\": \"main\",", ""), HasSubstr("'default' is missing"));
  EXPECT_THAT(error("\"default\"", "\"defualt\""), HasSubstr("defualt"));
  EXPECT_THAT(error("\"distance_m\": 0.020", "\"distance_mm\": 20"), HasSubstr("distance"));
  EXPECT_THAT(error("0.020", "20"), HasSubstr("ports.main.distance_m is 20"));
  EXPECT_THAT(error("0.020", "-0.02"), HasSubstr("distance_m is -0.02"));
  EXPECT_THAT(error("0.020", "\"2 cm\""), HasSubstr("2 cm"));
  EXPECT_THAT(error("0.014", "-0.014"), HasSubstr("thickness_m is -0.014"));
  EXPECT_THAT(error("0.014", "null"), HasSubstr("thickness_m is null"));
  EXPECT_THAT(error("1.52", "0.9"), HasSubstr("n_glass is 0.9"));
  EXPECT_THAT(error("1.333", "1333"), HasSubstr("n_water is 1333"));
  EXPECT_THAT(error("\"n_air\": 1.0", "\"n_air\": 1.4"), HasSubstr("n_air is 1.4"));
  EXPECT_THAT(error("[0, 0, 1]", "[0, 0, 0]"), HasSubstr("main.normal"));
  EXPECT_THAT(error("[0, 0, 1]", "[0, 0, -1]"), HasSubstr("backwards"));
  EXPECT_THAT(error("[0, 0, 1]", "[0, 1, 0]"), HasSubstr("backwards"));
  EXPECT_THAT(error("[0, 0, 1]", "[0, 0]"), HasSubstr("three numbers"));
  EXPECT_THAT(error("[0, 0, 1]", "[0, 0, 1e400]"), HasSubstr("JSON"));
  EXPECT_THAT(error("\"type\": \"flat\"", "\"type\": \"dome\""), HasSubstr("distance_m"));
  EXPECT_THAT(error("\"type\": \"flat\"", "\"type\": \"cube\""), HasSubstr("cube"));
  EXPECT_THAT(error("\"default\": \"main\"", "\"default\": \"mian\""), HasSubstr("mian"));
  EXPECT_THAT(error("\"2\": \"tilted\"", "\"2\": \"x\""), HasSubstr("cameras.2 is 'x'"));
  EXPECT_THAT(error("\"2\": \"tilted\"", "\"two\": \"tilted\""), HasSubstr("two"));
  EXPECT_THAT(error("\"2\": \"tilted\"", "\"2\": 3"), HasSubstr("expected a text"));
  EXPECT_THAT(error("jpg\": \"none\"", "jpg\": \"nona\""), HasSubstr("nona"));
  EXPECT_THAT(error("\"tilted\": {", "\"main\": {"), HasSubstr("occurs twice"));
  EXPECT_THAT(error("\"tilted\": {", "\"none\": {"), HasSubstr("none"));
  EXPECT_THAT(error("{ \"version\"", "[ \"version\""), HasSubstr("JSON"));
}

TEST_F(HousingTest, RefusesToWriteWhatCannotBeRead) {
  Housing housing = read(kExample);
  housing.default_port = "gone";
  EXPECT_THAT(error_of([&] { write_housing(file_, housing); }), HasSubstr("gone"));
  housing = read(kExample);
  flat(housing.ports["main"]).thickness = -1;
  EXPECT_THAT(error_of([&] { write_housing(file_, housing); }), HasSubstr("thickness_m is -1"));
  housing = read(kExample);
  housing.images["\xFF.jpg"] = "none";
  EXPECT_THAT(error_of([&] { write_housing(file_, housing); }), HasSubstr(file_.string()));
}

TEST_F(HousingTest, StandsBesideTheScene) {
  EXPECT_EQ(housing_beside("/a/scene.mvs"), "/a/scene.housing.json");
  EXPECT_EQ(housing_beside("/a/b.c/scene"), "/a/b.c/scene.housing.json");
}

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

TEST_F(HousingTest, EveryLineNamesTheFile) {
  Housing housing = read(kExample);
  housing.cameras.clear();
  housing.images = {{"gone.jpg", "main"}};
  Scene scene;
  scene.images.emplace_back().path = "/x/a.jpg";
  LogCapture log;
  attach_ports(scene, housing, "h.json");
  EXPECT_THAT(log.text(), HasSubstr("h.json: no image matches images.gone.jpg"));
  housing.cameras = {{1, "main"}};
  EXPECT_THAT(error_of([&] { attach_ports(scene, housing, "h.json"); }),
              testing::StartsWith("h.json: housing.cameras "));
  const Housing lake = read(kLake);
  scene.images = {looking_down("/x/diver.jpg", 1)};
  EXPECT_THAT(error_of([&] { attach_ports(scene, lake, "h.json"); }),
              testing::StartsWith("h.json: /x/diver.jpg: its port 'lake'"));
}

TEST_F(HousingTest, DoesNotGuessAtCameraIds) {
  const Housing housing = read(kExample);
  Scene scene;
  scene.images.emplace_back().path = "/x/left/a.jpg";
  attach_ports(scene, housing, "h.json");
  scene.images.emplace_back().path = "/x/b.jpg";
  EXPECT_THAT(error_of([&] { attach_ports(scene, housing, "h.json"); }), HasSubstr("/x/b.jpg"));
}

TEST_F(HousingTest, SurvivesWrongInput) {
  const auto reader = [](const fs::path& file) { read_housing(file); };
  // The last byte is a newline, which JSON does not need.
  test::expect_prefixes_refused(file_, kExample, reader, kExample.size() - 1);
  test::expect_damage_survived(file_, kExample, reader);
  test::expect_damage_survived(file_, kLake, reader);
  const std::string deep(100000, '[');
  EXPECT_THAT(error_of([&] { read(deep); }), HasSubstr("JSON"));
  EXPECT_THAT(error_of([&] { read(deep + std::string(100000, ']')); }), HasSubstr("braces"));
}

}  // namespace
}  // namespace axial::io
