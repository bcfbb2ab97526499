// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: conversion between z-depth, which .dmap files hold, and lambda, the distance
// along the pixel's ray (see DepthMap).
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <utility>

#include "private/only_for_io.h"
#include "scene/camera_model.h"

namespace axial::io {

// One ray in the camera frame: z = o_z + lambda d_z.
struct DepthAlongRay {
  double origin_z, direction_z;

  double z(double lambda) const { return origin_z + lambda * direction_z; }
  double lambda(double z_depth) const { return (z_depth - origin_z) / direction_z; }
};

// The ray of the image centre.
DepthAlongRay centre_ray(const CameraModel& camera);

// Return the given map with every valid value converted to z-depth or to lambda. Error that starts
// with `file` if a value or a result is not finite or not positive.
cv::Mat1f z_depth_of(const cv::Mat1f& lambda, const CameraModel& camera, const std::string& file);
cv::Mat1f lambda_of(const cv::Mat1f& z_depth, const CameraModel& camera, const std::string& file);

// The range [low, high], extended to contain all valid depths.
std::pair<float, float> enclosing(double low, double high, const cv::Mat1f& depth);

}  // namespace axial::io
