// SPDX-License-Identifier: GPL-3.0-or-later
// A sphere, six cameras around it, in air or behind flat ports, and points on the sphere with their
// views.
#pragma once

#include <Eigen/Geometry>
#include <numbers>
#include <random>

#include "scene/any_camera.h"
#include "scene/point_cloud.h"
#include "scene/scene.h"
#include "worlds/ports.h"

namespace axial::test {

inline constexpr double kSphereRadius = 0.3;

inline Scene cameras_around_sphere(bool behind_ports) {
  Scene scene;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      SceneImage image;
      image.path = "image";
      image.camera.width = image.camera.height = 400;
      image.camera.lens = {300, 300, 199.5, 199.5};
      if (behind_ports) image.camera.port = flat_port(0.05);
      const Eigen::Vector3d centre = side * Eigen::Vector3d::Unit(axis);
      const Eigen::Quaterniond towards =
          Eigen::Quaterniond::FromTwoVectors(-centre, Eigen::Vector3d::UnitZ());
      image.pose.rotation = towards.toRotationMatrix();
      image.pose.centre = centre;
      scene.images.push_back(image);
    }
  return scene;
}

// Returns evenly spread points on the sphere, moved along the normal by `noise` [m] times a normal
// random number. The views of a point are the cameras that its surface faces.
inline PointCloud points_on_sphere(const Scene& scene, std::size_t count, double noise = 0) {
  PointCloud cloud;
  std::mt19937 random(1);
  std::normal_distribution<double> error(0, 1);
  cloud.view_begin.push_back(0);
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double turn = std::numbers::pi * (1 + std::sqrt(5.0)) * static_cast<double>(i);
    const double r = std::sqrt(1 - z * z);
    const Eigen::Vector3d normal(r * std::cos(turn), r * std::sin(turn), z);
    const Eigen::Vector3d at = (kSphereRadius + noise * error(random)) * normal;
    cloud.positions.push_back(at.cast<float>());
    cloud.normals.push_back(normal.cast<float>());
    for (std::uint32_t v = 0; v < scene.images.size(); ++v)
      if ((scene.images[v].pose.centre - at).normalized().dot(normal) > 0.2)
        cloud.view_images.push_back(v);
    cloud.view_begin.push_back(cloud.view_images.size());
  }
  return cloud;
}

}  // namespace axial::test
