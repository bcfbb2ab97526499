// SPDX-License-Identifier: GPL-3.0-or-later
// Distinguishes realistic port values from values that no port has under water.
#include "cameras/private/port_values.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <functional>
#include <numbers>

#include "colmap/private/colmap_parts.h"
#include "support/captured_events.h"
#include "support/empty_folder.h"

namespace axial::io {
namespace {

using refractive::DomePort;
using refractive::FlatPort;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

FlatPort<double> flat() {
  return {{0, 0, 1}, 0.03, 0.018, 1, 1.49, 1.333};
}
DomePort<double> dome() {
  return {{0, 0, 0.002}, 0.05, 0.007, 1, 1.52, 1.34};
}

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

std::string said_of(const HousingPort& port) {
  test::CapturedEvents log;
  warn_of_port_values(port, "port.json: housing.ports.main", log.context);
  return log.lines;
}

FlatPort<double> tilted(double degrees) {
  FlatPort<double> port = flat();
  port.normal = Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Eigen::Vector3d(0.6, 0.8, 0)) *
                port.normal;
  return port;
}

TEST(PortValues, UsualPortsPass) {
  for (const double n_water : {1.30, 1.325, 1.333, 1.34, 1.36, 1.40})
    for (const double n_glass : {1.30, 1.46, 1.49, 1.52, 1.77, 2.0}) {
      FlatPort<double> port = flat();
      DomePort<double> other = dome();
      port.n_water = other.n_water = n_water;
      port.n_glass = other.n_glass = n_glass;
      EXPECT_EQ(said_of(port), "");
      EXPECT_EQ(said_of(other), "");
    }
  for (const double degrees : {0, 3, 15, 29}) EXPECT_EQ(said_of(tilted(degrees)), "") << degrees;
  EXPECT_EQ(said_of(WaterSurface{}), "");
  EXPECT_EQ(said_of(FlatPort<double>{}), "") << "index 1 throughout is no port at all";
}

TEST(PortValues, EachUnusualValueIsNamedWithFileAndField) {
  for (const double n_water : {1.0, 1.2, 1.29, 1.41, 1.49, 2.5}) {
    FlatPort<double> port = flat();
    DomePort<double> other = dome();
    port.n_water = other.n_water = n_water;
    port.n_glass = other.n_glass = 1.5;
    const std::string field = fmt::format("port.json: housing.ports.main.n_water is {}", n_water);
    for (const HousingPort& each : {HousingPort(port), HousingPort(other)}) {
      EXPECT_THAT(said_of(each), HasSubstr(field));
      EXPECT_EQ(lines(said_of(each)), 1u);
    }
    WaterSurface surface;
    surface.n_water = n_water;
    EXPECT_THAT(said_of(surface), HasSubstr(field));
  }
  for (const double n_glass : {1.0, 1.2, 2.1, 3.0}) {
    FlatPort<double> port = flat();
    port.n_glass = n_glass;
    EXPECT_THAT(said_of(port), HasSubstr(fmt::format("main.n_glass is {}", n_glass)));
  }
  for (const double degrees : {31, 45, 80})
    EXPECT_THAT(said_of(tilted(degrees)), AllOf(HasSubstr("main.normal is ["),
                                                HasSubstr(fmt::format("{} degrees", degrees))));
}

TEST(PortValues, CamerasOfOnePortAreNamedOnce) {
  FlatPort<double> wrong = flat();
  wrong.n_water = 1;
  std::vector<ColmapCamera> cameras(20);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    cameras[i].id = static_cast<std::uint32_t>(i + 1);
    cameras[i].port = wrong;
  }
  test::CapturedEvents log;
  warn_of_port_values(cameras, "sparse/cameras.txt", log.context);
  EXPECT_THAT(log.lines, HasSubstr("sparse/cameras.txt: camera 1: port.n_water is 1"));
  EXPECT_EQ(lines(log.lines), 1u);
}

// Warnings for three images on a line behind `port`, which see points at `distance`.
std::string said_in_scene(const HousingPort& port, double distance, double outliers = 0) {
  Scene scene;
  const Housing housing = housing_with(port);
  for (int i = 0; i < 3; ++i) {
    SceneImage image;
    image.path = "image" + std::to_string(i);
    image.camera.width = image.camera.height = 100;
    image.camera.lens = {100, 100, 49.5, 49.5};
    image.pose.centre = {0.01 * i, 0, 0};
    scene.images.push_back(image);
  }
  for (int k = 0; k < 100; ++k) {
    SparsePoint point;
    const double z = k < 100 * outliers ? 0.001 : distance * (0.9 + 0.002 * k);
    point.position = Eigen::Vector3d(0.1 * z, 0.001 * k * z, z).cast<float>();
    for (std::uint32_t i = 0; i < 3; ++i) point.views.push_back({i, 0});
    scene.points.push_back(point);
  }
  test::CapturedEvents log;
  attach_ports(scene, housing, "port.json", log.context);
  return log.lines;
}

TEST(PortsInScene, PortsBeforeTheScenePass) {
  for (const double distance : {0.15, 0.8, 8.0, 24.0})
    for (const HousingPort& port : {HousingPort(flat()), HousingPort(dome())}) {
      EXPECT_EQ(said_in_scene(port, distance), "") << distance;
      EXPECT_EQ(said_in_scene(port, distance, 0.3), "") << "a third of the points are wrong";
    }
}

TEST(PortsInScene, PortsThatReachBeyondTheSceneAreNamed) {
  EXPECT_THAT(said_in_scene(flat(), 0.02), HasSubstr("port.json: housing.ports.main.distance_m is "
                                                     "0.03, but 300 of 300 observations"));
  EXPECT_THAT(said_in_scene(flat(), 0.04), HasSubstr("main.thickness_m is 0.018, but"));
  EXPECT_THAT(said_in_scene(dome(), 0.03), HasSubstr("main.inner_radius_m is 0.05, but"));
  EXPECT_EQ(lines(said_in_scene(flat(), 0.02)), 1u) << "once a port, not once an image";
}

TEST(PortsInScene, NoWaterIsThatClear) {
  for (const HousingPort& port : {HousingPort(flat()), HousingPort(dome())})
    EXPECT_THAT(said_in_scene(port, 30), HasSubstr("more than 25 m of water away"));
}

TEST(PortsInScene, SceneAboveTheWater) {
  WaterSurface surface;
  surface.normal = {0, 0, 1};
  surface.point = {0, 0, 2};
  EXPECT_EQ(said_in_scene(surface, 3), "");
  // The warning does not print the point, because its numbers differ from the file's if the scene
  // has an offset.
  EXPECT_THAT(
      said_in_scene(surface, 1),
      AllOf(HasSubstr("port.json: housing.ports.main.point_m or normal is wrong: 300 of 300"),
            Not(HasSubstr("[0, 0, 2]"))));
}

// Reading a file warns once for each port, but not if the file is only compared.
TEST(PortValues, HousingFilesAreChecked) {
  FlatPort<double> wrong = flat();
  wrong.n_water = 1;
  const auto file = test::empty_folder() / "port.json";
  write_housing(file, housing_with(wrong));
  test::CapturedEvents log;
  read_housing(file, PortValues::passed_over, log.context);
  EXPECT_EQ(log.lines, "");
  read_housing(file, PortValues::checked, log.context);
  EXPECT_THAT(log.lines, HasSubstr(file.string() + ": housing.ports.main.n_water is 1"));
  EXPECT_EQ(lines(log.lines), 1u);
}

}  // namespace
}  // namespace axial::io
