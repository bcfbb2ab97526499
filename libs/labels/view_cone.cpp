// SPDX-License-Identifier: GPL-3.0-or-later
#include "labels/view_cone.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace axial::labels {
namespace {

constexpr double kMargin = 0.05;  // [rad], for rays between those that are looked at
constexpr int kSteps = 8;         // along each side

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

ViewCone::ViewCone(const PosedRays& rays)
    : apex_(rays.posed().pose.centre), axis_(rays.posed().pose.rotation.row(2).transpose()) {
  const double width = rays.posed().camera.width, height = rays.posed().camera.height;
  for (int j = 0; j <= kSteps; ++j)
    for (int i = 0; i <= kSteps; ++i) {
      const auto sight = rays.sight({i * width / kSteps - 0.5, j * height / kSteps - 0.5});
      angle_ = std::max(angle_, sight ? angle_between(axis_, sight->direction) : std::numbers::pi);
      if (sight) beside_ = std::max(beside_, (sight->from - apex_).norm());
    }
  angle_ += kMargin;
}

bool ViewCone::may_meet(const Eigen::Vector3d& centre, double radius) const {
  const Eigen::Vector3d way = centre - apex_;
  const double distance = way.norm(), around = radius + beside_;
  return distance <= around ||
         angle_between(axis_, way) <= angle_ + std::asin(std::min(1.0, around / distance));
}

}  // namespace axial::labels
