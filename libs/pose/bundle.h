// SPDX-License-Identifier: GPL-3.0-or-later
// What refractive bundle adjustment moves: cameras, poses and points, and the observations that tie
// them. World frame and metres throughout; pixels with centres at integers.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "pose/housing_change.h"
#include "scene/pose.h"

namespace axial::pose {

struct BundleCamera {
  CameraModel measured;
  HousingChange<double> change = HousingChange<double>::Zero();

  CameraModel now() const { return moved(measured, change); }
};

struct BundleImage {
  std::string name;
  std::size_t camera = 0;  // index into Bundle::cameras
  Pose pose;
};

struct BundlePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::size_t source = 0;  // what it was in the model it comes from
};

struct Observation {
  std::size_t image = 0;
  std::size_t point = 0;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  // of the camera's pinhole lens
  // From the pinhole's pixels to those of the photograph, where a lens distorts: errors are
  // measured there.
  Eigen::Matrix2d to_photograph = Eigen::Matrix2d::Identity();
  // Where a lens distorts, another focal length takes the distortion away from another place: the
  // derivative of `pixel` by the logarithm of the focal lengths' factor.
  Eigen::Vector2d pixel_by_focal = Eigen::Vector2d::Zero();
  std::size_t source = 0;  // what it was in the model it comes from

  // `pixel` with the camera's lens changed so, to first order.
  Eigen::Vector2d pixel_with(const HousingChange<double>& change) const {
    return pixel + pixel_by_focal * change(kFocalNumber);
  }
};

struct Bundle {
  std::vector<BundleCamera> cameras;
  std::vector<BundleImage> images;
  std::vector<BundlePoint> points;
  std::vector<Observation> observations;
};

// The index of the point that was `source`. Error if it is not, or no longer, in the bundle.
std::size_t point_of(const Bundle& bundle, std::size_t source);

std::vector<std::size_t> observations_by_image(const Bundle& bundle);  // their numbers

// Reprojection errors [px of the photograph] of all observations, in their order; infinite where
// the point's light does not reach the camera.
std::vector<double> reprojection_errors(const Bundle& bundle);

// Root of the mean of the squared errors; those that are infinite do not count. 0 if none does.
double root_mean_square(std::span<const double> errors);

}  // namespace axial::pose
