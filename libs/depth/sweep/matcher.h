// SPDX-License-Identifier: GPL-3.0-or-later
// Scores plane hypotheses of one reference view against its source views, for any camera and any
// warp. Matcher scores one pair of plane and view at a time. LaneMatcher scores several pairs at
// once in SIMD registers. Matcher is the reference in the tests of LaneMatcher. It also runs the
// methods of the paper, which LaneMatcher does not have.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "axial/depth.h"
#include "depth/patch/zncc.h"
#include "depth/plane_map.h"
#include "depth/views/geometric_check.h"
#include "depth/views/ray_caster.h"
#include "depth/views/reference_pixel.h"
#include "depth/views/warp.h"

namespace axial::depth {

inline constexpr std::size_t kMaxSources = 32;  // largest number of source views

template <class Camera>
struct SourceView {
  Camera camera;
  RelativePose from_reference;  // from the reference camera's frame to this camera's frame
  const QuadImage* image = nullptr;
  // The depth map of the view [m], with the size of `image`. Null: photometric cost only.
  const cv::Mat1f* depth = nullptr;
};

// A plane hypothesis and a source view in which the plane is scored, both as indices.
struct ScorePair {
  std::uint8_t plane, view;
};

// The score of one plane hypothesis in one source view.
struct PlaneScore {
  // From 0 to kMaxCost, computed in four steps. First, the cost c is 1 - ZNCC, or kOutsideCost
  // without a correlation. Second, if the source view has a depth map, geometric_weight times the
  // geometric term (inconsistency() in geometric_check.h) is added to c. The term is
  // geometric_limit if the source view does not show the patch's centre. Third, c is blended with
  // the prior: c += w (min(|depth - prior| / prior, 0.5) - c), where w is the prior's weight.
  // Fourth, a cost above kMaxCost is reduced to kMaxCost.
  float cost;
  // Motion of the patch's centre in the source view per metre of depth [px/m]; 0: not visible.
  float motion;
  // Factor of the cost, at most 1 (smoothness.h). `cost` does not contain it. It is equal in all
  // views of a plane.
  float smoothness;
};

// Scores plane hypotheses one after the other. `Warp`: a warp policy (warp.h).
template <class Camera, class Warp>
class Matcher {
 public:
  // `image`: the reference image. `camera`: the reference camera. `image`, and the images and depth
  // maps of the sources, must outlive the matcher. Precondition: each source has an image.
  Matcher(const cv::Mat1b& image, Camera camera, std::vector<SourceView<Camera>> sources,
          const PatchMatchOptions& options)
      : pixels_(image, camera, options),
        caster_(std::move(camera)),
        sources_(std::move(sources)),
        options_(options),
        zncc_(fastest_zncc()) {}

  std::size_t views() const { return sources_.size(); }  // number of source views
  // Prepares pixels of the reference image for score().
  const PixelSampler<Camera>& pixels() const { return pixels_; }
  // Sets `tile` to the rays of the reference camera, as RayCaster::rays() does.
  void rays(int x, int y, RayTile& tile) const { caster_.rays(x, y, tile); }

  // Sets scores[i] to the score of planes[pairs[i].plane] in the source view pairs[i].view. The
  // smoothness factors compare the planes with `neighbours`, the surface at neighbouring pixels.
  // `pixel`: the result of pixels().prepare(), with or without a prior. Preconditions: all indices
  // are valid; `scores` has at least the size of `pairs`.
  void score(const ReferencePixel& pixel, std::span<const PlaneHypothesis> planes,
             std::span<const ScorePair> pairs, std::span<const SurfacePoint> neighbours,
             std::span<PlaneScore> scores) const {
    PatchDerivative patch;
    float smoothness = 1;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const PlaneHypothesis& plane = planes[pairs[i].plane];
      if (i == 0 || pairs[i].plane != pairs[i - 1].plane) {
        patch = patch_derivative(pixel.ray, pixel.jacobian, plane);
        smoothness =
            depth::smoothness<float>(patch.point, plane.normal, neighbours, options_.smoothness);
      }
      const SourceView<Camera>& source = sources_[pairs[i].view];
      scores[i] = {cost(pixel, plane, patch, source), motion(pixel, patch, source), smoothness};
    }
  }

 private:
  float cost(const ReferencePixel& pixel, const PlaneHypothesis& plane,
             const PatchDerivative& patch, const SourceView<Camera>& source) const {
    const auto map = Warp::between(pixels_.camera(), pixel.at(), plane, patch, source.camera,
                                   source.from_reference);
    float correlation = kNoCorrelation;
    if (map.visible) {
      TexelPositions at;
      Warp::texels(map, pixel.at(), at);
      correlation = zncc_(pixel.patch, *source.image, at);
    }
    float sum = correlation == kNoCorrelation ? kOutsideCost : 1.0f - correlation;
    if (source.depth)
      sum += options_.geometric_weight *
             (map.visible ? inconsistency(pixel.ray, pixel.jacobian, plane.depth,
                                          source.from_reference.apply(patch.point), map.centre,
                                          source.camera, source.from_reference, *source.depth,
                                          options_.geometric_limit)
                          : options_.geometric_limit);
    if (pixel.prior_weight > 0) {
      const float off = std::abs(plane.depth - pixel.prior_depth) / pixel.prior_depth;
      sum += pixel.prior_weight * (std::min(off, 0.5f) - sum);
    }
    return std::min(sum, kMaxCost);
  }

  float motion(const ReferencePixel& pixel, const PatchDerivative& patch,
               const SourceView<Camera>& source) const {
    refractive::Matrix23<float> jacobian;
    const auto image = source.camera.project(source.from_reference.apply(patch.point), &jacobian);
    if (!image.visible) return 0;
    return (jacobian * (source.from_reference.rotation * pixel.ray.direction)).norm();
  }

  PixelSampler<Camera> pixels_;
  RayCaster<Camera> caster_;
  std::vector<SourceView<Camera>> sources_;
  PatchMatchOptions options_;
  ZnccFunction zncc_;
};

}  // namespace axial::depth
