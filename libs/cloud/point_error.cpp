// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/point_error.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace axial::cloud {
namespace {

// Fitted to the distances from the truth of clouds of SimulateUnderwater's closeup and reef (seeds
// 21 and 22, in water and in air, at two resolutions), by the likelihood of normal errors.
constexpr double kNoise = 3.67;       // of a match of cost 1 that looks along the normal [px]
constexpr double kCostPower = 1.5;    // how it falls with the cost
constexpr double kSlantPower = -0.8;  // how it grows as the cosine of ray and normal falls
constexpr double kLeastCosine = 0.1;

// The same for the odds of staying within 3 errors.
constexpr double kOdds = 91;
constexpr double kPixelPower = 0.9;      // of the error in pixels at the point
constexpr double kScatterPower = -1.07;  // of the scatter in errors
constexpr double kLeastScatter = 0.05;   // [errors]
constexpr double kLeastOdds = 4;         // no points have less that fusion accepts

constexpr double kNoCost = 0.999;  // maps without confidence have 1, but for rounding

struct Summary {
  double cost = 1;     // the least of the supports'
  double pixel = 0;    // mean width of a pixel at the point [m]
  double cosine = 0;   // mean of rays and normal
  double scatter = 0;  // standard deviation of the supports' points along the normal [m]
};

Summary summarise(std::span<const PointSupport> supports, const Eigen::Vector3d& normal) {
  const auto views = static_cast<double>(supports.size());
  Summary sum;
  double offset = 0, square = 0;
  for (const PointSupport& support : supports) {
    sum.cost = std::min(sum.cost, support.cost);
    sum.pixel += std::sqrt(2 / support.jacobian.squaredNorm()) / views;
    sum.cosine += std::abs(normal.dot(support.ray)) / views;
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
  support.ray = pose_.rotation.transpose() * ray.direction;
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
  if (!(summary.cost < kNoCost)) return {};
  const double noise = kNoise * std::pow(summary.cost, kCostPower) *
                       std::pow(std::max(summary.cosine, kLeastCosine), kSlantPower);
  const auto views = static_cast<double>(supports.size());
  const double error = noise * views * triangulated_error(supports, normal);
  const double odds =
      std::max(kLeastOdds, kOdds * std::pow(error / summary.pixel, kPixelPower) *
                               std::pow(summary.scatter / error + kLeastScatter, kScatterPower));
  return {static_cast<float>(error), static_cast<float>(odds / (1 + odds))};
}

}  // namespace axial::cloud
