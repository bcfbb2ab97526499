// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/target_survey.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <random>

#include "pose/control/target_shape.h"

namespace axial::pose::testing {
namespace {

// The images of points; nothing if one is outside the photograph.
std::optional<std::vector<Eigen::Vector2d>> images_of(const Bundle& truth,
                                                      const PhotographCamera& camera,
                                                      const BundleImage& image,
                                                      const std::vector<Eigen::Vector3d>& points) {
  const auto& lens = truth.cameras[image.camera].measured.lens;
  std::vector<Eigen::Vector2d> pixels;
  for (const Eigen::Vector3d& point : points) {
    const PhotographImage seen = camera.image(image.pose.to_camera(point));
    const Eigen::Vector2d& p = seen.pixel;
    if (!seen.visible || p.minCoeff() < 0 || p.x() > lens.width - 1 || p.y() > lens.height - 1)
      return {};
    pixels.push_back(p);
  }
  return pixels;
}

// The outline of a dot, or the corners of a square.
std::vector<Eigen::Vector3d> outline_of(const Plate& plate) {
  const Eigen::Vector3d across = plate.normal.unitOrthogonal();
  const Eigen::Vector3d along = plate.normal.cross(across);
  const int count = plate.is_square ? 4 : 720;
  std::vector<Eigen::Vector3d> outline;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count;
    const double radius = plate.size * (plate.is_square ? std::sqrt(2.0) : 1.0);
    outline.push_back(plate.centre + radius * (std::cos(angle) * across + std::sin(angle) * along));
  }
  return outline;
}

// Area moments of a polygon by Green's theorem: the ellipse of equal area, centroid and second
// moments.
struct Ellipse {
  Eigen::Vector2d centre;
  Eigen::Matrix2d to_circle;
};

Ellipse ellipse_of(const std::vector<Eigen::Vector2d>& polygon) {
  const Eigen::Vector2d origin = polygon.front();
  double area = 0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d a = polygon[i] - origin, b = polygon[(i + 1) % polygon.size()] - origin;
    const double cross = a.x() * b.y() - a.y() * b.x();
    area += cross / 2;
    first += cross / 6 * (a + b);
    second +=
        cross / 24 *
        (2 * a * a.transpose() + 2 * b * b.transpose() + a * b.transpose() + b * a.transpose());
  }
  const Eigen::Vector2d centre = first / area;
  const Eigen::Matrix2d covariance = second / area - centre * centre.transpose();
  // A uniform ellipse has a quarter of its squared half axes as covariance.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(4 * covariance);
  return {centre + origin, solver.operatorInverseSqrt()};
}

}  // namespace

SeenPlates seen_plates(const Bundle& truth, const std::vector<Plate>& plates, double noise,
                       unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, 1);
  const auto error = [&]() -> Eigen::Vector2d {
    const double x = normal(random);
    return noise * Eigen::Vector2d(x, normal(random));
  };
  const std::vector<PhotographCamera> cameras = cameras_now(truth);
  SeenPlates seen;
  for (const Plate& plate : plates) {
    Target target{plate.label, {}, 0};
    std::vector<Eigen::Vector2d> centres;
    for (std::size_t i = 0; i < truth.images.size(); ++i) {
      const PhotographCamera& camera = cameras[truth.images[i].camera];
      const auto outline = images_of(truth, camera, truth.images[i], outline_of(plate));
      if (!outline) continue;
      TargetImage image;
      image.image = i;
      image.sigma = noise;
      if (plate.is_square) {
        std::array<Eigen::Vector2d, 4> corners;
        std::copy_n(outline->begin(), 4, corners.begin());
        image.pixel = diagonals_meet(corners) + error();
        image.corners = corners;
      } else {
        const Ellipse ellipse = ellipse_of(*outline);
        image.pixel = ellipse.centre + error();
        image.dot = ellipse.to_circle;
      }
      centres.push_back(camera.image(truth.images[i].pose.to_camera(plate.centre)).pixel);
      target.images.push_back(image);
    }
    seen.targets.push_back(target);
    seen.centres.push_back(centres);
  }
  return seen;
}

const Target& target_named(const std::vector<Target>& targets, const std::string& label) {
  return *std::ranges::find(targets, label, &Target::label);
}

}  // namespace axial::pose::testing
