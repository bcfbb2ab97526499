// SPDX-License-Identifier: GPL-3.0-or-later
// Simulated photographs of a board under water: the board's corners by the exact projection, with a
// given noise.
#pragma once

#include <Eigen/Geometry>
#include <numbers>
#include <random>

#include "calibrate/board_bundle.h"
#include "drawn.h"
#include "io/colmap/colmap_lens.h"

namespace axial::calibrate::testing {

inline constexpr double kDegree = std::numbers::pi / 180;

inline const Board kBoard{BoardKind::checkerboard, 9, 6, 0.025, 0, ""};

inline refractive::FlatPort<double> flat_port(double tilt_degrees = 1.5, double distance = 0.025) {
  const double tilt = tilt_degrees * kDegree;
  return {{std::sin(tilt) * 0.6, -std::sin(tilt) * 0.8, std::cos(tilt)},
          distance,
          0.01,
          1,
          1.49,
          1.334};
}

inline refractive::DomePort<double> dome_port() {
  return {{0.003, -0.002, 0.004}, 0.05, 0.007, 1, 1.49, 1.334};
}

inline const io::ColmapCamera kPinhole{1, "PINHOLE", 1024, 768, {610, 615, 512, 384}};
inline const io::ColmapCamera kDistorting{
    1, "OPENCV", 1024, 768, {620, 615, 512, 384, -0.12, 0.02, 1e-4, -2e-4}};

// A common camera and board: three megapixels and 126 corners.
inline const io::ColmapCamera kUsual{1, "PINHOLE", 2048, 1536, {1220, 1220, 1024, 768}};
inline const Board kUsualBoard{BoardKind::checkerboard, 14, 9, 0.025, 0, ""};

inline CameraModel camera_of(const io::ColmapCamera& lens, const refractive::Port<double>& port) {
  return {static_cast<int>(lens.width), static_cast<int>(lens.height), io::lens_of(lens).pinhole,
          port};
}

struct SurveyOptions {
  int views = 25;
  double nearest = 0.28, farthest = 0.6;  // [m]
  double steepest = 35;                   // [degrees]
  double noise = 0;                       // standard deviation per axis [px]
  unsigned seed = 1;
  // All corners lie in this part of the image, as fractions of the width and the height of the
  // image.
  Eigen::AlignedBox2d within{Eigen::Vector2d(0.01, 0.01), Eigen::Vector2d(0.99, 0.99)};
};

// Returns the images of the board's corners by the lens behind the port. Empty if a corner is not
// visible or its image is outside `within` (SurveyOptions::within).
inline std::vector<Corner> seen_corners(const io::ColmapCamera& lens,
                                        const refractive::Port<double>& port, const Pose& pose,
                                        const Board& board, const Eigen::AlignedBox2d& within) {
  const CameraModel model = camera_of(lens, port);
  const auto camera = make_camera<double>(model);
  std::vector<Corner> seen;
  for (const Eigen::Vector3d& corner : corners_of(board)) {
    const auto image =
        std::visit([&](const auto& c) { return c.project(pose.to_camera(corner)); }, camera);
    const Eigen::Vector3d bearing = model.lens.bearing(image.pixel);
    const Eigen::Vector2d pixel = image_direction(io::lens_of(lens), bearing.x(), bearing.y());
    const Eigen::Vector2d share(pixel.x() / model.width, pixel.y() / model.height);
    if (!image.visible || !within.contains(share)) return {};
    seen.push_back({seen.size(), pixel});
  }
  return seen;
}

struct Survey {
  std::vector<Pose> poses;
  std::vector<View> views;
};

inline Survey survey(const io::ColmapCamera& lens, const refractive::Port<double>& port,
                     const SurveyOptions& options = {}, const Board& board = kBoard) {
  std::mt19937_64 random(options.seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::normal_distribution<double> noise(0, 1);
  const auto corners = corners_of(board);
  const Eigen::Vector3d middle = (corners.front() + corners.back()) / 2;
  Survey result;
  while (result.views.size() < static_cast<std::size_t>(options.views)) {
    const double z = uniform(options.nearest, options.farthest);
    const double turn = uniform(0, 360) * kDegree;
    const Eigen::Vector3d axis(std::cos(turn), std::sin(turn), 0);
    const double tilt = uniform(0.5, 1) * options.steepest * kDegree;
    Pose pose;
    pose.rotation = Eigen::AngleAxisd(tilt, axis).toRotationMatrix() *
                    Eigen::AngleAxisd(uniform(-20, 20) * kDegree, Eigen::Vector3d::UnitZ());
    const double y = uniform(-0.4, 0.4) * z;
    pose.centre =
        middle - pose.rotation.transpose() * Eigen::Vector3d(uniform(-0.5, 0.5) * z, y, z);
    std::vector<Corner> seen = seen_corners(lens, port, pose, board, options.within);
    if (seen.empty()) continue;
    for (Corner& corner : seen)
      corner.pixel += options.noise * axial::test::drawn<2>(noise, random);
    result.poses.push_back(pose);
    result.views.push_back({"view" + std::to_string(result.views.size()) + ".png", seen});
  }
  return result;
}

inline double angle_degrees(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) / kDegree;
}

}  // namespace axial::calibrate::testing
