// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/first_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/order_statistics.h"

namespace axial::view {
namespace {

Eigen::Vector3d unit_or(const Eigen::Vector3d& direction, const Eigen::Vector3d& otherwise) {
  const double length = direction.norm();
  return length > 1e-3 ? Eigen::Vector3d(direction / length) : otherwise;
}

}  // namespace

FirstView first_view(const PointCloud& cloud, std::span<const SceneImage> images, bool z_is_up) {
  FirstView view;
  std::vector<float> values(cloud.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = cloud.positions[i][axis];
    view.centre[axis] = lower_quantile(values, 0.5);
  }
  const Eigen::Vector3f centre = view.centre.cast<float>();
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = (cloud.positions[i] - centre).norm();
  view.radius = std::max(static_cast<double>(lower_quantile(std::move(values), 0.9)), 1e-6);

  Eigen::Vector3d towards(0, 0, 0), up(0, 0, 0);
  for (const SceneImage& image : images) {
    if (!image.calibrated) continue;
    towards += image.pose.rotation.row(2).transpose();
    up -= image.pose.rotation.row(1).transpose();
  }
  view.towards = unit_or(towards, view.towards);
  view.up = z_is_up ? Eigen::Vector3d::UnitZ() : unit_or(up, view.up);
  // The viewer cannot look along `up`.
  if (view.up.cross(view.towards).norm() < 0.05)
    view.towards = (view.towards + 0.2 * view.up.unitOrthogonal()).normalized();
  return view;
}

}  // namespace axial::view
