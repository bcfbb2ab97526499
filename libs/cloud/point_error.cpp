// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/point_error.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace axial::cloud {
namespace {

// Fitted to the distances from the truth of clouds of SimulateUnderwater's closeup and reef (seeds
// 21 and 22, in water and in air, fused with three views and with two), by the likelihood of
// normally distributed errors.
constexpr double kNoise = 5.4;        // of a pixel that matches at cost 1 [px]
constexpr double kCostPower = 1.6;    // how it falls with the cost
constexpr double kViewsPower = 0.75;  // 0: views count as independent; 0.5: as one another's copies

// The same for the odds of staying within 3 errors.
constexpr double kOdds = 98;
constexpr double kPixelPower = 0.8;      // of the error in pixels at the point
constexpr double kScatterPower = -0.87;  // of the scatter in errors
constexpr double kLeastScatter = 0.05;   // [errors]

// Means over the supports.
struct Summary {
  double cost = 0;
  double pixel = 0;    // width of a pixel at the point [m]
  double scatter = 0;  // standard deviation of the supports' points along the normal [m]
};

Summary summarise(std::span<const PointSupport> supports, const Eigen::Vector3d& normal) {
  const auto views = static_cast<double>(supports.size());
  Summary sum;
  double offset = 0, square = 0;
  for (const PointSupport& support : supports) {
    sum.cost += support.cost / views;
    sum.pixel += std::sqrt(2 / support.jacobian.squaredNorm()) / views;
    const double along = normal.dot(support.point - supports.front().point);
    offset += along / views;
    square += along * along / views;
  }
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
PointSupport SupportCamera::support(std::uint32_t pixel, double depth, double cost) const {
  refractive::AxialRayJacobian<double> by_pixel;
  const auto ray = camera_.ray({pixel % width_, pixel / width_}, by_pixel);
  Eigen::Matrix3d motion;
  motion.leftCols<2>() = by_pixel.origin + depth * by_pixel.direction;
  motion.col(2) = ray.direction;
  PointSupport support;
  support.point = pose_.to_world(ray.at(depth));
  support.jacobian = motion.inverse().topRows<2>() * pose_.rotation;
  support.depth = depth;
  support.cost = cost;
  return support;
}

double triangulated_error(std::span<const PointSupport> supports, const Eigen::Vector3d& normal) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double depth = 0;
  for (const PointSupport& support : supports) {
    information += support.jacobian.transpose() * support.jacobian;
    depth += support.depth / static_cast<double>(supports.size());
  }
  information.diagonal().array() += 1 / (depth * depth);
  return std::sqrt(normal.dot(information.inverse() * normal));
}

PointError expected_error(std::span<const PointSupport> supports, const Eigen::Vector3d& normal) {
  if (supports.size() < 2) return {};
  const Summary summary = summarise(supports, normal);
  if (!(summary.cost < 1)) return {};
  const double noise = kNoise * std::pow(summary.cost, kCostPower) *
                       std::pow(static_cast<double>(supports.size()), kViewsPower);
  const double error = noise * triangulated_error(supports, normal);
  const double odds = kOdds * std::pow(error / summary.pixel, kPixelPower) *
                      std::pow(summary.scatter / error + kLeastScatter, kScatterPower);
  return {static_cast<float>(error), static_cast<float>(odds / (1 + odds))};
}

}  // namespace axial::cloud
