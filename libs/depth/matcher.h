// SPDX-License-Identifier: GPL-3.0-or-later
// Scores plane hypotheses of one reference view against its source views. The one place where
// cameras meet images; the camera and the warp are template parameters, so neither costs a branch.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "depth/geometric_check.h"
#include "depth/options.h"
#include "depth/patch.h"
#include "depth/plane_map.h"
#include "depth/warp.h"
#include "depth/zncc.h"

namespace axial::depth {

inline constexpr std::size_t kMaxSources = 32;
inline constexpr float kOutsideCost = 1.2f;  // of a patch that leaves the source image
inline constexpr float kMaxCost = 2.0f;

template <class Camera>
struct SourceView {
  Camera camera;
  RelativePose from_reference;
  const QuadImage* image = nullptr;
  const cv::Mat1f* depth = nullptr;  // of the source view itself; null: photometric only
};

// Everything about one reference pixel that does not depend on the hypothesis.
struct ReferencePixel {
  int x = 0, y = 0;
  refractive::AxialRay<float> ray;
  refractive::AxialRayJacobian<float> jacobian;
  ReferencePatch patch;
  float prior_depth = 0;   // from the coarser level; 0: none
  float prior_weight = 0;  // how little the texture says, 0 to 1

  Eigen::Vector2f at() const { return {static_cast<float>(x), static_cast<float>(y)}; }
};

// Per-view costs of one hypothesis and the order of the views, best first.
struct ViewCosts {
  std::array<float, kMaxSources> cost{};
  std::array<std::uint8_t, kMaxSources> order{};
};

// Mean of the two smallest costs; the second only counts below kOutsideCost.
inline float aggregate(float smallest, float second) {
  return second < kOutsideCost ? 0.5f * (smallest + second) : smallest;
}

template <class Camera, class Warp>
class Matcher {
 public:
  Matcher(const cv::Mat1b& image, Camera camera, std::vector<SourceView<Camera>> sources,
          const PatchMatchOptions& options)
      : image_(image),
        camera_(std::move(camera)),
        sources_(std::move(sources)),
        options_(options),
        sampler_(options),
        zncc_(fastest_zncc()) {}

  const Camera& camera() const { return camera_; }

  // Precondition: the window around (x, y) lies inside the image.
  ReferencePixel prepare(int x, int y) const {
    ReferencePixel pixel;
    pixel.x = x;
    pixel.y = y;
    pixel.ray = camera_.ray({static_cast<float>(x), static_cast<float>(y)}, pixel.jacobian);
    pixel.patch = sampler_.gather(image_, x, y);
    return pixel;
  }

  // A depth known from elsewhere (0: none) that counts the more, the less the texture says.
  void set_prior(ReferencePixel& pixel, float depth) const {
    pixel.prior_depth = depth;
    pixel.prior_weight = depth > 0 ? std::exp(-pixel.patch.texture / options_.prior_texture) : 0.0f;
  }

  // Cost of one hypothesis in one view, in [0, 2].
  float view_cost(const ReferencePixel& pixel, const PlaneHypothesis& plane,
                  const PatchDerivative& patch, std::size_t view) const {
    return cost_of(pixel, plane, patch, view, map_into(pixel, plane, patch, view));
  }

  // Photometric (and geometric) cost over all views; `costs` gets each view's and their order.
  float score_all(const ReferencePixel& pixel, const PlaneHypothesis& plane,
                  ViewCosts& costs) const {
    const PatchDerivative patch = patch_derivative(pixel.ray, pixel.jacobian, plane);
    const std::size_t count = sources_.size();
    std::array<typename Warp::Map, kMaxSources> maps;
    for (std::size_t i = 0; i < count; ++i) maps[i] = map_into(pixel, plane, patch, i);
    for (std::size_t i = 0; i < count; ++i) {
      costs.cost[i] = cost_of(pixel, plane, patch, i, maps[i]);
      std::size_t k = i;  // insertion: ties keep the better-scored neighbour first
      for (; k > 0 && costs.cost[costs.order[k - 1]] > costs.cost[i]; --k)
        costs.order[k] = costs.order[k - 1];
      costs.order[k] = static_cast<std::uint8_t>(i);
    }
    return count == 1 ? costs.cost[0]
                      : aggregate(costs.cost[costs.order[0]], costs.cost[costs.order[1]]);
  }

  // The same over the best `views` of an earlier order: never below the cost over all of them.
  float score_best(const ReferencePixel& pixel, const PlaneHypothesis& plane,
                   const ViewCosts& ranked, std::size_t views) const {
    const PatchDerivative patch = patch_derivative(pixel.ray, pixel.jacobian, plane);
    views = std::min(views, sources_.size());
    std::array<typename Warp::Map, kMaxSources> maps;
    for (std::size_t k = 0; k < views; ++k)
      maps[k] = map_into(pixel, plane, patch, ranked.order[k]);
    float smallest = kMaxCost;
    float second = kMaxCost;
    for (std::size_t k = 0; k < views; ++k) {
      const float cost = cost_of(pixel, plane, patch, ranked.order[k], maps[k]);
      if (cost < smallest) {
        second = smallest;
        smallest = cost;
      } else {
        second = std::min(second, cost);
      }
    }
    return views == 1 ? smallest : aggregate(smallest, second);
  }

  // How far the patch's centre moves in source view `view` per metre of depth [px/m]; 0 if unseen.
  float pixels_per_metre(const ReferencePixel& pixel, float depth, std::size_t view) const {
    const SourceView<Camera>& source = sources_[view];
    refractive::Matrix23<float> jacobian;
    const auto image =
        source.camera.project(source.from_reference.apply(pixel.ray.at(depth)), &jacobian);
    if (!image.visible) return 0;
    return (jacobian * (source.from_reference.rotation * pixel.ray.direction)).norm();
  }

 private:
  typename Warp::Map map_into(const ReferencePixel& pixel, const PlaneHypothesis& plane,
                              const PatchDerivative& patch, std::size_t view) const {
    return Warp::between(camera_, pixel.at(), plane, patch, sources_[view].camera,
                         sources_[view].from_reference);
  }

  float cost_of(const ReferencePixel& pixel, const PlaneHypothesis& plane,
                const PatchDerivative& patch, std::size_t view,
                const typename Warp::Map& map) const {
    const SourceView<Camera>& source = sources_[view];
    float correlation = kNoCorrelation;
    if (map.visible) {
      TexelPositions at;
      Warp::texels(map, pixel.at(), at);
      correlation = zncc_(pixel.patch, *source.image, at);
    }
    float cost = correlation == kNoCorrelation ? kOutsideCost : 1.0f - correlation;
    if (source.depth)
      cost += options_.geometric_weight *
              (map.visible
                   ? inconsistency(camera_, pixel.at(), source.from_reference.apply(patch.point),
                                   map.centre, source.camera, source.from_reference, *source.depth,
                                   options_.geometric_limit)
                   : options_.geometric_limit);
    if (pixel.prior_weight > 0) {
      const float off = std::abs(plane.depth - pixel.prior_depth) / pixel.prior_depth;
      cost += pixel.prior_weight * (std::min(off, 0.5f) - cost);
    }
    return std::min(cost, kMaxCost);
  }

  const cv::Mat1b& image_;
  Camera camera_;
  std::vector<SourceView<Camera>> sources_;
  PatchMatchOptions options_;
  PatchSampler sampler_;
  ZnccFunction zncc_;
};

}  // namespace axial::depth
