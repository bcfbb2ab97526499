// SPDX-License-Identifier: GPL-3.0-or-later
// What a reference pixel brings to every hypothesis about it.
#pragma once

#include <array>
#include <cmath>
#include <opencv2/core.hpp>

#include "depth/options.h"
#include "depth/patch.h"
#include "refractive/axial_ray.h"

namespace axial::depth {

struct PixelRay {
  refractive::AxialRay<float> ray;
  refractive::AxialRayJacobian<float> jacobian;
};

// Those of the pixels of a row from one on: computed together, in lanes where there are such.
inline constexpr int kRayTile = 16;
using RayTile = std::array<PixelRay, kRayTile>;

struct ReferencePixel : PixelRay {
  int x = 0, y = 0;
  ReferencePatch patch;
  float prior_depth = 0;   // from the coarser level; 0: none
  float prior_weight = 0;  // how little the texture says, 0 to 1

  Eigen::Vector2f at() const { return {static_cast<float>(x), static_cast<float>(y)}; }
};

template <class Camera>
class PixelSampler {
 public:
  // `image` must outlive the sampler.
  PixelSampler(const cv::Mat1b& image, Camera camera, const PatchMatchOptions& options)
      : image_(image),
        camera_(std::move(camera)),
        sampler_(options),
        prior_texture_(options.prior_texture) {}

  const Camera& camera() const { return camera_; }

  PixelRay ray(int x, int y) const {
    PixelRay pixel;
    pixel.ray = camera_.ray({static_cast<float>(x), static_cast<float>(y)}, pixel.jacobian);
    return pixel;
  }

  // `ray`: the pixel's own. Precondition: the window around (x, y) lies inside the image.
  ReferencePixel prepare(int x, int y, const PixelRay& ray) const {
    ReferencePixel pixel;
    static_cast<PixelRay&>(pixel) = ray;
    pixel.x = x;
    pixel.y = y;
    sampler_.gather(image_, x, y, pixel.patch);
    return pixel;
  }
  ReferencePixel prepare(int x, int y) const { return prepare(x, y, ray(x, y)); }

  // A depth known from elsewhere (0: none) that counts the more, the less the texture says.
  void set_prior(ReferencePixel& pixel, float depth) const {
    pixel.prior_depth = depth;
    pixel.prior_weight = depth > 0 ? std::exp(-pixel.patch.texture / prior_texture_) : 0.0f;
  }

 private:
  const cv::Mat1b& image_;
  Camera camera_;
  PatchSampler sampler_;
  float prior_texture_;
};

}  // namespace axial::depth
