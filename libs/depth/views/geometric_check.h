// SPDX-License-Identifier: GPL-3.0-or-later
// Forward-backward consistency of a hypothesis with the depth map of a source view: the paper's eq.
// (7), with exact projections in place of virtual images.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core.hpp>

#include "depth/consistency.h"
#include "depth/views/warp.h"

namespace axial::depth {

// Returns the depth [m] of a map at the sub-pixel position `at` [px]. The result is the mean, with
// bilinear weights, over the four pixels around the position. A pixel is left out if its depth
// differs from `expected` [m] by tolerance * expected or more. Returns 0 if all four pixels are
// left out or if the position is outside the map. Precondition: the map is at least 2x2 pixels.
inline float depth_near(const cv::Mat1f& depth, const Eigen::Vector2f& at, float expected,
                        float tolerance) {
  if (!(at.x() >= 0 && at.y() >= 0 && at.x() <= static_cast<float>(depth.cols - 1) &&
        at.y() <= static_cast<float>(depth.rows - 1)))
    return 0;
  const int x0 = std::min(static_cast<int>(at.x()), depth.cols - 2);
  const int y0 = std::min(static_cast<int>(at.y()), depth.rows - 2);
  const float fx = at.x() - static_cast<float>(x0);
  const float fy = at.y() - static_cast<float>(y0);
  float sum = 0;
  float weight_sum = 0;
  for (int dy = 0; dy < 2; ++dy) {
    const float* row = depth.ptr<float>(y0 + dy) + x0;
    for (int dx = 0; dx < 2; ++dx) {
      const float value = row[dx];
      if (!(std::abs(value - expected) < tolerance * expected)) continue;
      const float weight = (dx ? fx : 1 - fx) * (dy ? fy : 1 - fy) + 1e-6f;
      sum += weight * value;
      weight_sum += weight;
    }
  }
  return weight_sum > 0 ? sum / weight_sum : 0;
}

// Returns the geometric term of the cost: sqrt(e (e + 2)) of the forward-backward error e [px], or
// `limit` if the term is larger. Let A be the surface point of the hypothesis. Let B be the point
// on the source view's ray through A at the depth that the source view's depth map has there. Then
// e is the distance between the images of A and B in the reference view, computed to first order
// (shift_in_pixels). Returns `limit`, too, if the image of A is outside the map, or if every depth
// of the map next to the image of A differs from the depth of A by the share kSameSurface or more.
//
// `ray`, `jacobian`: the reference pixel's ray and its derivatives by the pixel, in the reference
// camera's frame. `depth`: the depth of the hypothesis along this ray [m]. `in_source`: the point A
// in the source camera's frame [m]. `seen_at`: the image of A in the source view [px]. `source`:
// the source camera. `from_reference`: from the reference camera's frame to the source camera's
// frame. `source_depth`: the depth map of the source view [m], at least 2x2 pixels.
template <class Camera>
float inconsistency(const refractive::AxialRay<float>& ray,
                    const refractive::AxialRayJacobian<float>& jacobian, float depth,
                    const Eigen::Vector3f& in_source, const Eigen::Vector2f& seen_at,
                    const Camera& source, const RelativePose& from_reference,
                    const cv::Mat1f& source_depth, float limit) {
  const Eigen::Vector3f along = in_source - source.ray(seen_at).origin;
  const float expected = along.norm();
  const float found = depth_near(source_depth, seen_at, expected, kSameSurface);
  if (!(found > 0)) return limit;
  const Eigen::Vector3f shift =
      from_reference.rotation.transpose() * (along * (found / expected - 1));
  return inconsistency_term(shift_in_pixels(ray, jacobian, depth, shift), limit);
}

}  // namespace axial::depth
