// SPDX-License-Identifier: GPL-3.0-or-later
// The matcher with SIMD. Supports exact projection and the affine warp, for pinholes, flat ports
// and dome ports, each with undistorted or distorted lenses. The source views that share a register
// have one kind of camera. The reference view may have a different kind of camera, because the
// scores need only the rays of the reference camera.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "depth/lanes/scorer.h"
#include "depth/sweep/matcher.h"
#include "depth/views/ray_caster.h"

namespace axial::depth {

// Has the functions of Matcher<Camera, AffineWarp> (matcher.h). The scores differ a little from
// those of Matcher: by rounding, and because the solver takes as many steps for every view as for
// the view that needs most.
template <InLanes Camera>
class LaneMatcher {
 public:
  // Copies the images and depth maps of the sources. `image`: the reference image, which must
  // outlive the matcher. `camera`: the reference camera. Throws an Error
  // - if a side of a source image is longer than lanes::kLargestSide,
  // - if the images of source views with one kind of camera have 2^31 pixels or more together. More
  //   than lanes::kLanes views of one kind are divided into groups, and the limit is for each
  //   group.
  //
  // Preconditions: at most kMaxSources sources; each source has an image; a source's depth map has
  // the size of its image; `set` is available.
  LaneMatcher(const cv::Mat1b& image, Camera camera, std::span<const SourceView<Camera>> sources,
              const PatchMatchOptions& options,
              lanes::InstructionSet set = lanes::fastest_instruction_set());

  std::size_t views() const { return views_; }
  const PixelSampler<Camera>& pixels() const { return pixels_; }
  void rays(int x, int y, RayTile& tile) const { caster_.rays(x, y, tile); }

  // Sets scores[i] to the score of planes[pairs[i].plane] in the source view pairs[i].view, as
  // Matcher::score() does. Preconditions: all indices are valid; `scores` has at least the size of
  // `pairs`; at most lanes::kLanes planes.
  void score(const ReferencePixel& pixel, std::span<const PlaneHypothesis> planes,
             std::span<const ScorePair> pairs, std::span<const SurfacePoint> neighbours,
             std::span<PlaneScore> scores) const;

 private:
  // Up to lanes::kLanes source views of one kind of camera.
  struct Group {
    std::unique_ptr<const lanes::SceneTables> tables;
    std::unique_ptr<const lanes::Scorer> scorer;
  };

  // The group of a source view and its index in this group.
  struct LaneOfView {
    std::uint8_t group, lane;
  };

  PixelSampler<Camera> pixels_;
  RayCaster<Camera> caster_;
  std::size_t views_;
  std::vector<Group> groups_;
  std::array<LaneOfView, kMaxSources> lane_of_view_{};  // by the index of the source view
};

}  // namespace axial::depth
