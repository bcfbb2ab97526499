// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/height_error.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "map/geotiff.h"

namespace axial::map {

HeightErrors::HeightErrors(std::span<const PosedCamera> photos, const Eigen::Vector3d& up,
                           double noise)
    : up_(up), noise_(noise) {
  for (const PosedCamera& photo : photos) {
    cameras_.emplace_back(make_camera<double>(photo.camera));
    poses_.push_back(photo.pose);
  }
}

float HeightErrors::at(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                       std::span<const std::uint32_t> views) const {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  // for a noise of 1 px [1/m^2]
  double distance = 0, finest = 0;                        // `finest`: [px^2/m^2]
  int count = 0;
  for (const std::uint32_t view : views) {
    refractive::Matrix23<double> by_camera;
    const Eigen::Vector3d in_camera = poses_[view].to_camera(point);
    if (!cameras_[view].project(in_camera, &by_camera).visible) continue;
    const refractive::Matrix23<double> by_point = by_camera * poses_[view].rotation;
    information += by_point.transpose() * by_point;
    finest = std::max(finest, by_point.squaredNorm() / 2);
    distance += in_camera.norm();
    ++count;
  }
  if (count < 2 || !(normal.norm() > 0)) return kNoHeight;
  information /= noise_ * noise_;
  // Parallel paths of light leave the distance open: it is then known as well as its mean.
  distance /= count;
  information.diagonal().array() += 1 / (distance * distance);
  const Eigen::Vector3d n = normal.normalized();
  const double intersection = n.dot(information.ldlt().solve(n));
  const double resolution = kResolution * kResolution / finest;
  return static_cast<float>(std::sqrt(intersection + resolution) /
                            std::max(kLeastCosine, std::abs(n.dot(up_))));
}

}  // namespace axial::map
