// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: converts between z-depth and lambda. Z-depth is the depth in .dmap files.
// Lambda is the distance along the ray of a pixel (see DepthMap).
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

// z_depth_of converts a map of lambda to z-depth. lambda_of converts a map of z-depth to lambda.
// The value 0 means no depth and stays 0. Error that starts with `file` if another value or its
// result is not finite or not positive.
cv::Mat1f z_depth_of(const cv::Mat1f& lambda, const CameraModel& camera, const std::string& file);
cv::Mat1f lambda_of(const cv::Mat1f& z_depth, const CameraModel& camera, const std::string& file);

// Returns the range [low, high], extended so that it contains all positive values of `depth`.
std::pair<float, float> enclosing(double low, double high, const cv::Mat1f& depth);

}  // namespace axial::io
