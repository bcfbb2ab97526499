// SPDX-License-Identifier: GPL-3.0-or-later
// Forward-backward consistency of a hypothesis with a source view's own depth map: the paper's eq.
// (7) with exact projection in place of the virtual image.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core.hpp>

#include "depth/consistency.h"
#include "depth/warp.h"

namespace axial::depth {

// Depth of the map at a sub-pixel position, bilinear among those of the four corners that lie
// within `tolerance` (relative) of `expected`; 0 if none does or the position is outside.
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

// sqrt(e (e + 2)) of the forward-backward error e in pixels, at most `limit`; `limit` where no
// consistent depth is stored at the point's image. `in_source`: the hypothesis' point in the source
// view's frame, `seen_at`: its image there.
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
