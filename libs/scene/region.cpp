// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/region.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/order_statistics.h"

namespace axial {
namespace {

// The point at which the cameras look.
struct ViewingCentre {
  Eigen::Vector3d centre;
  double radius = 0;     // distance of the farthest camera from the centre
  double agreement = 0;  // length of the mean viewing direction: 1 if all are parallel
};

ViewingCentre viewing_centre(const std::vector<const Pose*>& poses) {
  Eigen::Vector3d middle, direction = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    values.reserve(poses.size());
    for (const Pose* pose : poses) values.push_back(pose->centre(axis));
    middle(axis) = upper_median(std::move(values));
  }
  std::vector<double> distances;
  for (const Pose* pose : poses) {
    direction += pose->rotation.row(2).transpose();
    distances.push_back((pose->centre - middle).norm());
  }
  ViewingCentre viewed;
  viewed.agreement = direction.norm() / static_cast<double>(poses.size());
  const double ahead = std::tan(std::asin(std::min(viewed.agreement, 0.999)));
  viewed.centre =
      middle + ahead * upper_median(std::move(distances)) * direction.stableNormalized();
  for (const Pose* pose : poses) {
    viewed.radius = std::max(viewed.radius, (pose->centre - viewed.centre).norm());
  }
  return viewed;
}

bool surrounds(const std::vector<const Pose*>& poses, const ViewingCentre& viewed) {
  if (viewed.agreement > std::numbers::sqrt2 / 2) return false;
  return std::all_of(poses.begin(), poses.end(),
                     [&](const Pose* pose) { return pose->to_camera(viewed.centre).z() > 0; });
}

bool seen_within(const Scene& scene, const SparsePoint& point, double limit) {
  const Eigen::Vector3d position = point.position.cast<double>();
  return std::any_of(point.views.begin(), point.views.end(), [&](const SparseView& view) {
    if (view.image >= scene.images.size() || !scene.images[view.image].calibrated) return false;
    return scene.images[view.image].pose.to_camera(position).z() < limit;
  });
}

}  // namespace

std::optional<OrientedBox> estimate_region(const Scene& scene, RegionMode mode) {
  std::vector<const Pose*> poses;
  for (const SceneImage& image : scene.images) {
    if (image.calibrated) poses.push_back(&image.pose);
  }
  if (mode == RegionMode::off || poses.size() < 3) return std::nullopt;
  const ViewingCentre viewed = viewing_centre(poses);
  if (mode == RegionMode::adaptive && !surrounds(poses, viewed)) return std::nullopt;

  Eigen::AlignedBox3d box;
  for (const SparsePoint& point : scene.points) {
    if (!point.position.allFinite() || !seen_within(scene, point, 2 * viewed.radius)) continue;
    box.extend(point.position.cast<double>());
  }
  if (box.isEmpty()) return std::nullopt;
  constexpr double kEnlarged = 1.1;
  OrientedBox region;
  region.centre = box.center();
  // The least side relative to the longest: sparse points in a plane would give a box without
  // volume.
  constexpr double kThinnest = 0.1;
  region.half_extent = kEnlarged / 2 * box.sizes().cwiseMax(kThinnest * box.sizes().maxCoeff());
  return region;
}

OrientedBox with_border(const OrientedBox& region, double border) {
  OrientedBox result = region;
  if (border > 0) result.half_extent *= border;
  if (border < 0) result.half_extent.array() -= border;
  return result;
}

}  // namespace axial
