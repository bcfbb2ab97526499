// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/point_error.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace axial::cloud {
namespace {

// kNoise and kOdds are rounded fits to distances from the truth: clouds of three maps and more of
// SimulateUnderwater's closeup and reef (seeds 21 and 22, in water and in air, at two resolutions),
// by the likelihood of normal errors. The powers of cost, number and cosine were chosen on the same
// clouds and a few others, among powers that square roots give. kLeastOdds was set by hand.
constexpr double kNoise = 3.7;  // of a match of cost 1 that looks along the normal [px]
constexpr double kOdds = 100;   // of staying within 3 errors, times pixel / error, scatter / error
constexpr double kLeastScatter = 0.05;  // [errors]
constexpr double kLeastOdds = 4;        // no points have less that fusion accepts
constexpr double kLeastCosine = 0.1;
constexpr double kNoCost = 0.999;  // maps without confidence have 1, but for rounding

struct Summary {
  double cost = 1;     // the least of the supports'
  double pixel = 0;    // width of a pixel at the point [m]
  double cosine = 0;   // mean of rays and normal
  double scatter = 0;  // standard deviation of the supports' points along the normal [m]
};

Summary summarise(std::span<const PointSupport> supports, const Eigen::Vector3d& normal) {
  const double share = 1 / static_cast<double>(supports.size());
  Summary sum;
  double offset = 0, square = 0, squared_scale = 0;
  for (const PointSupport& support : supports) {
    sum.cost = std::min(sum.cost, support.cost);
    squared_scale += 0.5 * share * support.jacobian.squaredNorm();
    sum.cosine += share * std::abs(normal.dot(support.ray));
    const double along = normal.dot(support.point - supports.front().point);
    offset += share * along;
    square += share * along * along;
  }
  sum.pixel = 1 / std::sqrt(squared_scale);
  sum.scatter = std::sqrt(std::max(square - offset * offset, 0.0));
  return sum;
}

}  // namespace

SupportCamera::SupportCamera(const CameraModel& model, const Pose& pose)
    : camera_(make_camera<double>(model)),
      pose_(pose),
      width_(static_cast<std::uint32_t>(model.width)) {}

// Points move with pixel and depth by M = [dX/du, dX/dv, dX/ddepth]; the first two rows of its
// inverse say how the pixel moves with the point.
PointSupport SupportCamera::support(std::uint32_t pixel, double depth, double cost,
                                    const Eigen::Vector3d& point) const {
  refractive::AxialRayJacobian<double> by_pixel;
  const auto ray = camera_.ray({pixel % width_, pixel / width_}, by_pixel);
  const Eigen::Vector3d by_u = by_pixel.origin.col(0) + depth * by_pixel.direction.col(0);
  const Eigen::Vector3d by_v = by_pixel.origin.col(1) + depth * by_pixel.direction.col(1);
  const Eigen::Vector3d across = by_v.cross(ray.direction);
  const double scale = 1 / by_u.dot(across);
  PointSupport support;
  support.point = point;
  support.ray = pose_.rotation.transpose() * ray.direction;
  Eigen::Matrix<double, 2, 3> in_camera;
  in_camera.row(0) = scale * across;
  in_camera.row(1) = scale * ray.direction.cross(by_u);
  support.jacobian = in_camera * pose_.rotation;
  support.depth = depth;
  support.cost = cost;
  return support;
}

double triangulated_error(std::span<const PointSupport> supports, const Eigen::Vector3d& normal) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double depth = 0;
  for (const PointSupport& support : supports) {
    information += support.jacobian.transpose() * support.jacobian;
    depth += support.depth;
  }
  depth /= static_cast<double>(supports.size());
  information.diagonal().array() += 1 / (depth * depth);
  return std::sqrt(normal.dot(information.inverse() * normal));
}

PointError expected_error(std::span<const PointSupport> supports, const Eigen::Vector3d& normal) {
  if (supports.size() < 2) return {};
  const Summary summary = summarise(supports, normal);
  if (!(summary.cost < kNoCost)) return {};
  const double cosine = std::max(summary.cosine, kLeastCosine);
  const double noise =
      kNoise * summary.cost * std::sqrt(summary.cost) / std::sqrt(cosine * std::sqrt(cosine));
  const auto views = static_cast<double>(supports.size());
  const double error = noise * views * triangulated_error(supports, normal);
  const double odds = std::max(
      kLeastOdds, kOdds * error / summary.pixel / (summary.scatter / error + kLeastScatter));
  return {static_cast<float>(error), static_cast<float>(odds / (1 + odds))};
}

}  // namespace axial::cloud
