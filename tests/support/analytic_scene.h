// SPDX-License-Identifier: GPL-3.0-or-later
// A plane with a sphere in front of it, and exact depth maps of this scene for any axial camera.
// Every pixel's ray is intersected with the surfaces in closed form.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "scene/camera_model.h"
#include "scene/depth_map.h"
#include "scene/scene.h"

namespace axial::test {

struct AnalyticScene {
  Eigen::Hyperplane<double, 3> plane{Eigen::Vector3d(0.1, -0.2, -1).normalized(),
                                     Eigen::Vector3d(0, 0, 1.0)};
  Eigen::Vector3d sphere_centre{0, 0, 0.85};
  double sphere_radius = 0;  // 0: no sphere

  struct Hit {
    double lambda;
    Eigen::Vector3d normal;
  };

  // The first intersection of the ray with a surface.
  std::optional<Hit> hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    std::optional<Hit> best;
    const double slope = direction.dot(plane.normal());
    if (slope < 0) best = Hit{-plane.signedDistance(origin) / slope, plane.normal()};
    const Eigen::Vector3d to_centre = sphere_centre - origin;
    const double along = to_centre.dot(direction);
    const double inside = sphere_radius * sphere_radius - to_centre.squaredNorm() + along * along;
    if (sphere_radius > 0 && inside > 0) {
      const double lambda = along - std::sqrt(inside);
      if (lambda > 0 && (!best || lambda < best->lambda)) {
        best = Hit{lambda, (origin + lambda * direction - sphere_centre).normalized()};
      }
    }
    return best;
  }

  double distance(const Eigen::Vector3d& x) const {
    double result = plane.absDistance(x);
    if (sphere_radius > 0) {
      result = std::min(result, std::abs((x - sphere_centre).norm() - sphere_radius));
    }
    return result;
  }
};

inline DepthMap exact_map(const AnalyticScene& scene, const CameraModel& model, const Pose& pose) {
  DepthMap map;
  map.image_path = "exact";
  map.camera = model;
  map.pose = pose;
  map.depth = cv::Mat1f(model.height, model.width, 0.0f);
  map.normal = cv::Mat3f(model.height, model.width, cv::Vec3f(0, 0, 0));
  map.confidence = cv::Mat1f(model.height, model.width, 0.5f);
  map.min_depth = std::numeric_limits<float>::max();
  std::visit(
      [&](const auto& camera) {
        for (int y = 0; y < model.height; ++y) {
          for (int x = 0; x < model.width; ++x) {
            const auto ray = camera.ray({x, y});
            const auto hit =
                scene.hit(pose.to_world(ray.origin), pose.rotation.transpose() * ray.direction);
            if (!hit || hit->lambda <= 0) continue;
            const Eigen::Vector3f n = (pose.rotation * hit->normal).template cast<float>();
            map.depth(y, x) = static_cast<float>(hit->lambda);
            map.normal(y, x) = {n.x(), n.y(), n.z()};
            map.min_depth = std::min(map.min_depth, map.depth(y, x));
            map.max_depth = std::max(map.max_depth, map.depth(y, x));
          }
        }
      },
      make_camera<double>(model));
  map.min_depth *= 0.5f;
  map.max_depth *= 2.0f;
  return map;
}

// A camera without a port, with 96 x 72 pixels and a horizontal field of view of about 65 degrees.
inline CameraModel dry_camera() {
  CameraModel model;
  model.width = 96;
  model.height = 72;
  model.lens = {75, 75, 47.2, 36.1};
  return model;
}

inline CameraModel behind_port(CameraModel model, double n_glass = 1.52, double n_water = 1.333) {
  refractive::FlatPort<double> port;
  port.normal = Eigen::Vector3d(0.05, -0.08, 1).normalized();
  port.distance = 0.02;
  port.thickness = 0.014;
  port.n_glass = n_glass;
  port.n_water = n_water;
  model.port = port;
  return model;
}

// `count` cameras on a circle around the z axis near the plane z = 0, looking at (0, 0, 1) and
// rotated about their optical axes. `radius` [m].
inline std::vector<Pose> circle_of_poses(std::size_t count, double radius = 0.2) {
  std::vector<Pose> poses(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2 * 3.14159265358979 * static_cast<double>(i) / static_cast<double>(count);
    poses[i].centre = {radius * std::cos(angle), radius * std::sin(angle),
                       0.01 * std::sin(3 * angle)};
    const Eigen::Vector3d z = (Eigen::Vector3d(0, 0, 1) - poses[i].centre).normalized();
    const Eigen::Vector3d x = Eigen::Vector3d(std::cos(0.1 * angle), std::sin(0.1 * angle), 0);
    const Eigen::Vector3d y = z.cross(x).normalized();
    poses[i].rotation << y.cross(z).transpose(), y.transpose(), z.transpose();
  }
  return poses;
}

// A scene with a camera `model` at each of `poses`, without sparse points.
inline Scene scene_of(const CameraModel& model, const std::vector<Pose>& poses) {
  Scene scene;
  for (const Pose& pose : poses) {
    SceneImage image;
    image.path = "image" + std::to_string(scene.images.size());
    image.id = static_cast<std::uint32_t>(scene.images.size());
    image.camera = model;
    image.pose = pose;
    scene.images.push_back(image);
  }
  return scene;
}

}  // namespace axial::test
