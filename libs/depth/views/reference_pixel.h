// SPDX-License-Identifier: GPL-3.0-or-later
// The data of a reference pixel that all hypotheses of the pixel use: ray, window and prior depth.
#pragma once

#include <array>
#include <cmath>
#include <opencv2/core.hpp>

#include "axial/depth.h"
#include "depth/patch/patch.h"
#include "refractive/axial_ray.h"

namespace axial::depth {

// The ray of a pixel and its derivatives by the pixel, in the camera's frame.
struct PixelRay {
  refractive::AxialRay<float> ray;
  refractive::AxialRayJacobian<float> jacobian;
};

// The rays of kRayTile consecutive pixels of a row, which are computed together, if possible with
// SIMD.
inline constexpr int kRayTile = 16;
using RayTile = std::array<PixelRay, kRayTile>;

struct ReferencePixel : PixelRay {
  int x = 0, y = 0;        // [px]
  ReferencePatch patch;    // the window around the pixel
  float prior_depth = 0;   // [m]; 0: no prior
  float prior_weight = 0;  // weight of the prior in the cost, 0 to 1; 0: no prior

  // The position (x, y).
  Eigen::Vector2f at() const { return {static_cast<float>(x), static_cast<float>(y)}; }
};

// Prepares the pixels of a reference image.
template <class Camera>
class PixelSampler {
 public:
  // `image`: the reference image, which must outlive the sampler. `camera`: its camera. Of the
  // options, only sigma_color, sigma_space and prior_texture are used.
  PixelSampler(const cv::Mat1b& image, Camera camera, const PatchMatchOptions& options)
      : image_(image),
        camera_(std::move(camera)),
        sampler_(options),
        prior_texture_(options.prior_texture) {}

  const Camera& camera() const { return camera_; }

  // Returns the ray of pixel (x, y), which may lie outside the image.
  PixelRay ray(int x, int y) const {
    PixelRay pixel;
    pixel.ray = camera_.ray({static_cast<float>(x), static_cast<float>(y)}, pixel.jacobian);
    return pixel;
  }

  // Returns the data of pixel (x, y), with its window and without a prior. `ray`: the ray of this
  // pixel. Precondition: (x, y) lies inside the image.
  ReferencePixel prepare(int x, int y, const PixelRay& ray) const {
    ReferencePixel pixel;
    static_cast<PixelRay&>(pixel) = ray;
    pixel.x = x;
    pixel.y = y;
    sampler_.gather(image_, x, y, pixel.patch);
    return pixel;
  }
  ReferencePixel prepare(int x, int y) const { return prepare(x, y, ray(x, y)); }

  // Sets a prior depth [m] (0: none) and its weight exp(-texture / options.prior_texture). Does not
  // change the other data of `pixel`. Precondition: `pixel` is a result of prepare().
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
