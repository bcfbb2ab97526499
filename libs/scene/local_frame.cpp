// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/local_frame.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/order_statistics.h"

namespace axial {
namespace {

constexpr double kNear = 1000;    // [units]; at this distance float resolves 6e-5 units
constexpr double kRounding = 10;  // of origins [units]

// The median of each coordinate. For an even number of values, the larger of the two in the middle.
Eigen::Vector3d median(std::span<const Eigen::Vector3d> places) {
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  std::vector<double> values(places.size());
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::ranges::transform(places, values.begin(), [&](const auto& x) { return x[axis]; });
    result[axis] = upper_median(values);
  }
  return result;
}

bool is_near(const Eigen::Vector3d& place) {
  return place.norm() <= kNear;
}

LocalFrame rounded(const Eigen::Vector3d& place) {
  // Adding 0 turns negative zeros into positive ones.
  return {place.unaryExpr([](double x) { return std::round(x / kRounding) * kRounding + 0.0; })};
}

}  // namespace

LocalFrame frame_near(const Eigen::Vector3d& place) {
  return is_near(place) ? LocalFrame{} : rounded(place);
}

LocalFrame frame_of(std::span<const Eigen::Vector3d> centres,
                    std::span<const Eigen::Vector3d> points) {
  if (centres.empty()) return {};
  if (std::ranges::all_of(centres, is_near) && (points.empty() || is_near(median(points))))
    return {};
  return rounded(median(centres));
}

LocalFrame frame_of(const Scene& scene) {
  std::vector<Eigen::Vector3d> centres, points;
  for (const SceneImage& image : scene.images)
    if (image.calibrated) centres.push_back(image.pose.centre);
  for (const SparsePoint& point : scene.points) points.emplace_back(point.position.cast<double>());
  return frame_of(centres, points);
}

void enter(const LocalFrame& frame, Scene& scene) {
  if (frame.is_world()) return;
  for (SceneImage& image : scene.images) image.pose.centre = frame.to_local(image.pose.centre);
  for (SparsePoint& point : scene.points)
    point.position = frame.to_local(point.position.cast<double>()).cast<float>();
  if (scene.region) scene.region->centre = frame.to_local(scene.region->centre);
}

}  // namespace axial
