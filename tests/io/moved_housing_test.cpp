// SPDX-License-Identifier: GPL-3.0-or-later
// Moves cameras, housings and points together: every point keeps its pixel.
#include "io/cameras/moved_housing.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "scene/camera_model.h"

namespace axial::io {
namespace {

Similarity turned(double scale) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, 3).normalized();
  return {scale, Eigen::AngleAxisd(0.7, axis).toRotationMatrix(), {4, -5, 6}};
}

// The pixel of `x` behind the port of the housing.
Eigen::Vector2d pixel(const Housing& housing, const Pose& pose, const Eigen::Vector3d& x) {
  CameraModel model{640, 480, {500, 500, 319.5, 239.5}, housing.port_at("main", pose, "image")};
  return std::visit(
      [&](const auto& camera) -> Eigen::Vector2d {
        return camera.project(pose.to_camera(x)).pixel;
      },
      make_camera<double>(model));
}

void expect_same_pixels(const HousingPort& port, double scale, bool scale_ports) {
  const Housing housing = housing_with(port);
  const Similarity similarity = turned(scale);
  const Housing after = moved(similarity, housing, scale_ports);
  const Pose pose;
  for (const Eigen::Vector3d& x : {Eigen::Vector3d(0.3, -0.2, 1.5), Eigen::Vector3d(-0.5, 0, 2)})
    EXPECT_LT((pixel(after, similarity(pose), similarity(x)) - pixel(housing, pose, x)).norm(),
              1e-8);
}

const Eigen::Vector3d kTilt = Eigen::Vector3d(0.1, 0.05, 1).normalized();

TEST(MovedHousing, RigidMotionsKeepThePorts) {
  expect_same_pixels(refractive::FlatPort<double>{kTilt, 0.02, 0.01, 1, 1.5, 1.33}, 1, false);
  expect_same_pixels(refractive::DomePort<double>{{0, 0.01, 0}, 0.1, 0.01, 1, 1.5, 1.33}, 1, false);
}

TEST(MovedHousing, PortsScaleWithTheScene) {
  expect_same_pixels(refractive::FlatPort<double>{kTilt, 0.02, 0.01, 1, 1.5, 1.33}, 2.5, true);
  expect_same_pixels(refractive::DomePort<double>{{0, 0.01, 0}, 0.1, 0.01, 1, 1.5, 1.33}, 2.5,
                     true);
  const Housing same =
      moved(turned(2.5), housing_with(refractive::FlatPort<double>{kTilt, 0.02}), false);
  EXPECT_EQ(std::get<refractive::FlatPort<double>>(same.ports.at("main")).distance, 0.02);
}

TEST(MovedHousing, WaterSurfacesMoveWithTheScene) {
  for (const bool scale_ports : {false, true})
    expect_same_pixels(WaterSurface{kTilt, {0.5, 0, 0.3}, 1, 1.33}, 2.5, scale_ports);
}

}  // namespace
}  // namespace axial::io
