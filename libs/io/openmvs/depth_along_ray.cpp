// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <variant>

#include "base/error.h"
#include "openmvs/private/dmap_parts.h"

namespace axial::io {
namespace {

template <class Camera>
DepthAlongRay depth_along_ray(const Camera& camera, double u, double v) {
  const auto ray = camera.ray({u, v});
  return {ray.origin.z(), ray.direction.z()};
}

// Returns `depth` with every valid value replaced by convert(ray, value).
template <class Convert>
cv::Mat1f converted(const cv::Mat1f& depth, const CameraModel& model, const std::string& file,
                    Convert convert) {
  cv::Mat1f result(depth.size(), 0.0f);
  const auto convert_all = [&](const auto& camera) {
    for (int v = 0; v < depth.rows; ++v)
      for (int u = 0; u < depth.cols; ++u) {
        const float value = depth(v, u);
        if (value == 0) continue;
        const DepthAlongRay ray = depth_along_ray(camera, u, v);
        const auto other = static_cast<float>(convert(ray, static_cast<double>(value)));
        if (!(value > 0 && std::isfinite(value) && other > 0 && std::isfinite(other)))
          fail_in(file, "depth at pixel ({}, {}) is {}, which is not a valid depth for this camera",
                  u, v, value);
        result(v, u) = other;
      }
  };
  std::visit(convert_all, make_camera<double>(model));
  return result;
}

}  // namespace

DepthAlongRay centre_ray(const CameraModel& camera) {
  return std::visit(
      [&](const auto& c) {
        return depth_along_ray(c, (camera.width - 1) / 2.0, (camera.height - 1) / 2.0);
      },
      make_camera<double>(camera));
}

cv::Mat1f z_depth_of(const cv::Mat1f& lambda, const CameraModel& camera, const std::string& file) {
  return converted(lambda, camera, file,
                   [](const DepthAlongRay& ray, double value) { return ray.z(value); });
}

cv::Mat1f lambda_of(const cv::Mat1f& z_depth, const CameraModel& camera, const std::string& file) {
  return converted(z_depth, camera, file,
                   [](const DepthAlongRay& ray, double value) { return ray.lambda(value); });
}

std::pair<float, float> enclosing(double low, double high, const cv::Mat1f& depth) {
  auto lowest = static_cast<float>(low);
  auto highest = static_cast<float>(high);
  for (const float value : depth)
    if (value > 0) {
      lowest = std::min(lowest, value);
      highest = std::max(highest, value);
    }
  return {lowest, highest};
}

}  // namespace axial::io
