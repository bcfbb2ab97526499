// SPDX-License-Identifier: GPL-3.0-or-later
// The reprojection errors of a reconstruction as vectors, with the cameras of its scene.
#pragma once

#include <span>
#include <vector>

#include "pose/bundle/bundle.h"
#include "scene/any_camera.h"
#include "scene/camera_model.h"

namespace axial::diagnosis {

// Photographs with the points that were found in them. Indices of images and points are as in
// Bundle. BundleImage::camera is an index into `cameras`. Lengths are in metres if a camera is
// behind a port.
struct TrackedPhotographs {
  std::vector<CameraModel> cameras;
  std::vector<pose::BundleImage> images;
  std::vector<Eigen::Vector3d> points;  // in the frame of the poses
  std::vector<pose::Observation> observations;
};

// One observation, linearized at the given pose and point. All derivatives are those of the
// projected pixel. The columns of `by_pose` are a rotation vector w [rad] and the camera centre C,
// as in PoseNumbers (observation_cost.h) at w = 0.
struct ObservationTerm {
  bool visible = false;  // false: the point has no image, and the other members are meaningless
  Eigen::Vector2d error = Eigen::Vector2d::Zero();  // the observed minus the projected pixel [px]
  Eigen::Matrix<double, 2, 6> by_pose;
  Eigen::Matrix<double, 2, 3> by_point;
};

// The term of a point [world] that was observed at `pixel`.
ObservationTerm observation_term(const AnyCamera<double>& camera, const Pose& pose,
                                 const Eigen::Vector3d& point, const Eigen::Vector2d& pixel);

// The cameras of `photographs`, in their order.
std::vector<AnyCamera<double>> cameras_of(const TrackedPhotographs& photographs);

// The errors of all observations, in their order: observed minus projected pixels [px]. Both
// components are NaN if the point has no image.
struct ResidualVectors {
  std::vector<Eigen::Vector2d> stated;  // with the poses of `photographs`
  // With the pose of each photograph moved by one least-squares step. The step does not use
  // outliers: errors above four times the robust standard deviation of the photograph. NaN in
  // photographs with fewer than kLeastObservations usable observations.
  std::vector<Eigen::Vector2d> freed;
};

inline constexpr std::size_t kLeastObservations = 10;

ResidualVectors residual_vectors(const TrackedPhotographs& photographs);

}  // namespace axial::diagnosis
