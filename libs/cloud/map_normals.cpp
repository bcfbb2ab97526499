// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/map_normals.h"

#include <Eigen/Geometry>
#include <cmath>

#include "base/parallel.h"
#include "scene/camera_model.h"

namespace axial::cloud {
namespace {

// The pixels' points in the camera frame; 0 where there is no depth.
cv::Mat3f points_of(const DepthMap& map) {
  cv::Mat3f points(map.depth.size(), cv::Vec3f(0, 0, 0));
  std::visit(
      [&](const auto& camera) {
        parallel_for(static_cast<std::size_t>(map.height()), [&](std::size_t row) {
          const int y = static_cast<int>(row);
          for (int x = 0; x < map.width(); ++x) {
            if (!(map.depth(y, x) > 0)) continue;
            const Eigen::Vector3f X =
                camera.ray({x, y}).at(static_cast<double>(map.depth(y, x))).template cast<float>();
            points(y, x) = {X.x(), X.y(), X.z()};
          }
        });
      },
      make_camera<double>(map.camera));
  return points;
}

Eigen::Vector3d vector_of(const cv::Vec3f& v) {
  return Eigen::Vector3f(v[0], v[1], v[2]).cast<double>();
}

// Least-squares fit of X(u, v) = X0 + a du + b dv to the 3x3 neighbourhood; the normal is a x b.
cv::Vec3f normal_at(const DepthMap& map, const cv::Mat3f& points, int y, int x) {
  constexpr double kSameSurface = 0.03;
  constexpr int kEnough = 3;
  const auto depth = static_cast<double>(map.depth(y, x));
  const Eigen::Vector3d centre = vector_of(points(y, x));
  Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
  Eigen::Matrix<double, 2, 3> right = Eigen::Matrix<double, 2, 3>::Zero();
  int count = 0;
  for (int v = std::max(0, y - 1); v <= std::min(map.height() - 1, y + 1); ++v) {
    for (int u = std::max(0, x - 1); u <= std::min(map.width() - 1, x + 1); ++u) {
      const auto other = static_cast<double>(map.depth(v, u));
      if ((u == x && v == y) || !(other > 0)) continue;
      if (!(std::abs(other - depth) < kSameSurface * depth)) continue;
      const Eigen::Vector2d step(u - x, v - y);
      square += step * step.transpose();
      right += step * (vector_of(points(v, u)) - centre).transpose();
      ++count;
    }
  }
  // Entries are small integers: a singular system has determinant 0 exactly.
  if (count < kEnough || !(square.determinant() > 0.5)) return {0, 0, 0};
  const Eigen::Matrix<double, 2, 3> slopes = square.inverse() * right;
  Eigen::Vector3d normal = slopes.row(0).cross(slopes.row(1));
  const double norm = normal.norm();
  if (!(norm > 0)) return {0, 0, 0};
  normal /= normal.dot(centre) > 0 ? -norm : norm;
  const Eigen::Vector3f result = normal.cast<float>();
  return {result.x(), result.y(), result.z()};
}

}  // namespace

cv::Mat3f estimate_map_normals(const DepthMap& map) {
  const cv::Mat3f points = points_of(map);
  cv::Mat3f normals(map.depth.size(), cv::Vec3f(0, 0, 0));
  parallel_for(static_cast<std::size_t>(map.height()), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < map.width(); ++x) {
      if (map.depth(y, x) > 0) normals(y, x) = normal_at(map, points, y, x);
    }
  });
  return normals;
}

}  // namespace axial::cloud
