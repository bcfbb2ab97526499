// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/control/target_shape.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/order_statistics.h"
#include "pose/bundle/tracks.h"

namespace axial::pose {
namespace {

using Ray = refractive::AxialRay<double>;

constexpr int kOutline = 16;  // rays or points of an outline
const Eigen::Vector2d kNone = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());

// Two unit vectors that are perpendicular to the unit vector n and to each other.
std::array<Eigen::Vector3d, 2> perpendicular_to(const Eigen::Vector3d& n) {
  const Eigen::Vector3d first = n.unitOrthogonal();
  return {first, n.cross(first)};
}

// The distance of the point where a ray meets the plane from the centre, in units of the radius,
// minus 1. Parameters: two tilts of the plane [tangents], logarithm of the radius.
struct OutlineResidual {
  Ray ray;
  Eigen::Vector3d centre, normal, across, along;

  template <class T>
  bool operator()(const T* plane, T* residual) const {
    using std::exp;
    using std::sqrt;
    Eigen::Matrix<T, 3, 1> tilted;
    for (int k = 0; k < 3; ++k) tilted(k) = normal(k) + plane[0] * across(k) + plane[1] * along(k);
    const Eigen::Vector3d to_centre = centre - ray.origin;
    T above(0), steepness(0);
    for (int k = 0; k < 3; ++k) {
      above += tilted(k) * to_centre(k);
      steepness += tilted(k) * ray.direction(k);
    }
    const T way = above / steepness;
    T squared(0);
    for (int k = 0; k < 3; ++k) {
      const T off = way * ray.direction(k) - to_centre(k);
      squared += off * off;
    }
    residual[0] = sqrt(squared) * exp(-plane[2]) - 1.0;
    return true;
  }
};

// Photographs from one direction determine the tilt weakly: it is probably not large.
struct TiltResidual {
  template <class T>
  bool operator()(const T* plane, T* residual) const {
    constexpr double kWeight = 1e-3;
    for (int k = 0; k < 2; ++k) residual[k] = kWeight * plane[k];
    return true;
  }
};

// The distance of the centre from the rays; a start for the radius.
double median_distance_to(const Eigen::Vector3d& centre,
                          std::span<const std::vector<Ray>> outlines) {
  std::vector<double> distances;
  for (const std::vector<Ray>& rays : outlines)
    for (const Ray& ray : rays)
      distances.push_back(ray.direction.normalized().cross(centre - ray.origin).norm());
  return upper_median(std::move(distances));
}

std::vector<Ray> outline_rays(const PhotographCamera& camera, const Pose& pose,
                              const TargetImage& image) {
  std::vector<Ray> rays;
  const Eigen::Matrix2d from_circle = image.dot.inverse();
  for (int k = 0; k < kOutline; ++k) {
    const double angle = 2 * std::numbers::pi * k / kOutline;
    const Ray ray =
        world_ray(camera, pose,
                  image.pixel + from_circle * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    if (ray.direction.allFinite()) rays.push_back(ray);
  }
  return rays;
}

Eigen::Vector2d projected(const PhotographCamera& camera, const Pose& pose,
                          const Eigen::Vector3d& point) {
  const PhotographImage image = camera.image(pose.to_camera(point));
  return image.visible ? image.pixel : kNone;
}

// The circle of a ring; nothing if no image shows its dot.
std::optional<Circle> circle_of(const Bundle& bundle, std::span<const PhotographCamera> cameras,
                                const Target& target, const Eigen::Vector3d& place) {
  std::vector<std::vector<Ray>> outlines;
  for (const TargetImage& image : target.images) {
    if (image.dot.isZero(0)) continue;
    const BundleImage& of = bundle.images[image.image];
    outlines.push_back(outline_rays(cameras[of.camera], of.pose, image));
    if (outlines.back().size() < 3) outlines.pop_back();
  }
  if (outlines.empty()) return {};
  return circle_about(place, outlines);
}

// The corners of a square [world]; nothing if rays do not determine one of them.
std::optional<std::array<Eigen::Vector3d, 4>> corners_of(const Bundle& bundle,
                                                         std::span<const PhotographCamera> cameras,
                                                         const Target& target) {
  std::array<Eigen::Vector3d, 4> corners;
  for (std::size_t k = 0; k < 4; ++k) {
    std::vector<Ray> rays;
    for (const TargetImage& image : target.images) {
      if (!image.corners) continue;
      const BundleImage& of = bundle.images[image.image];
      const Ray ray = world_ray(cameras[of.camera], of.pose, (*image.corners)[k]);
      if (ray.direction.allFinite()) rays.push_back(ray);
    }
    const auto corner = triangulate(rays);
    if (!corner) return {};
    corners[k] = *corner;
  }
  return corners;
}

}  // namespace

Circle circle_about(const Eigen::Vector3d& centre, std::span<const std::vector<Ray>> outlines) {
  Circle circle{centre, Eigen::Vector3d::Zero(), median_distance_to(centre, outlines)};
  for (const std::vector<Ray>& rays : outlines)
    circle.normal -= (centre - rays.front().origin).normalized();
  circle.normal.normalize();
  const auto [across, along] = perpendicular_to(circle.normal);
  std::array<double, 3> plane{0, 0, std::log(circle.radius)};
  ceres::Problem problem;
  for (const std::vector<Ray>& rays : outlines)
    for (const Ray& ray : rays)
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<OutlineResidual, 1, 3>(
                                   new OutlineResidual{ray, centre, circle.normal, across, along}),
                               new ceres::HuberLoss(0.1), plane.data());
  problem.AddResidualBlock(new ceres::AutoDiffCostFunction<TiltResidual, 2, 3>(new TiltResidual),
                           nullptr, plane.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  circle.normal = (circle.normal + plane[0] * across + plane[1] * along).normalized();
  circle.radius = std::exp(plane[2]);
  return circle;
}

Eigen::Vector2d centre_of_image(const Circle& circle, const PhotographCamera& camera,
                                const Pose& pose) {
  const auto [across, along] = perpendicular_to(circle.normal);
  const Eigen::Vector2d middle = projected(camera, pose, circle.centre);
  Eigen::Matrix<double, kOutline, 2> outline;
  for (int k = 0; k < kOutline; ++k) {
    const double angle = 2 * std::numbers::pi * k / kOutline;
    outline.row(k) = (projected(camera, pose,
                                circle.centre + circle.radius * (std::cos(angle) * across +
                                                                 std::sin(angle) * along)) -
                      middle)
                         .transpose();
  }
  const double size = outline.rowwise().norm().maxCoeff();
  if (!(size > 0) || !outline.allFinite()) return kNone;
  outline /= size;
  // a u^2 + b u v + c v^2 + d u + e v = 1
  const Eigen::ArrayXd u = outline.col(0).array(), v = outline.col(1).array();
  Eigen::Matrix<double, kOutline, 5> terms;
  terms << (u * u).matrix(), (u * v).matrix(), (v * v).matrix(), u.matrix(), v.matrix();
  const Eigen::VectorXd conic = terms.colPivHouseholderQr().solve(Eigen::VectorXd::Ones(kOutline));
  Eigen::Matrix2d gradient;
  gradient << 2 * conic(0), conic(1), conic(1), 2 * conic(2);
  return middle - size * gradient.inverse() * conic.tail(2);
}

Eigen::Vector2d diagonals_meet(const std::array<Eigen::Vector2d, 4>& corners) {
  Eigen::Matrix2d directions;
  directions << corners[2] - corners[0], corners[1] - corners[3];
  const Eigen::Vector2d ways = directions.inverse() * (corners[1] - corners[0]);
  return corners[0] + ways(0) * (corners[2] - corners[0]);
}

std::vector<Eigen::Vector2d> centre_corrections(const Bundle& bundle,
                                                std::span<const PhotographCamera> cameras,
                                                const Target& target,
                                                const Eigen::Vector3d& place) {
  const std::optional<Circle> circle = circle_of(bundle, cameras, target, place);
  const auto corners = circle ? std::nullopt : corners_of(bundle, cameras, target);
  std::vector<Eigen::Vector2d> corrections;
  for (const TargetImage& image : target.images) {
    const BundleImage& of = bundle.images[image.image];
    const PhotographCamera& camera = cameras[of.camera];
    Eigen::Vector2d correction = kNone;
    if (circle && !image.dot.isZero(0)) {
      correction = projected(camera, of.pose, place) - centre_of_image(*circle, camera, of.pose);
    } else if (corners && image.corners) {
      std::array<Eigen::Vector2d, 4> seen;
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (std::size_t k = 0; k < 4; ++k) {
        seen[k] = projected(camera, of.pose, (*corners)[k]);
        middle += (*corners)[k] / 4;
      }
      correction = projected(camera, of.pose, middle) - diagonals_meet(seen);
    }
    corrections.push_back(correction.allFinite() ? correction : Eigen::Vector2d::Zero());
  }
  return corrections;
}

}  // namespace axial::pose
