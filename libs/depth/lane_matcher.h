// SPDX-License-Identifier: GPL-3.0-or-later
// The matcher with SIMD. Supports exact projection and the affine warp, for pinholes, flat ports
// and dome ports, each with undistorted or distorted lenses. The source views that share a register
// have the same kind of camera. The reference view may have another kind of camera, because the
// scores need only the rays of the reference camera.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "depth/lanes/scorer.h"
#include "depth/matcher.h"
#include "depth/ray_caster.h"

namespace axial::depth {

template <InLanes Camera>
class LaneMatcher {
 public:
  // Copies the images and depth maps of the sources. `image`: the reference image, which must
  // outlive the matcher. Throws an Error if a side of a source image is longer than
  // lanes::kLargestSide. Throws an Error, too, if the source images of one Group have 2^31 pixels
  // or more together. Preconditions: at most kMaxSources sources; `set` is available.
  LaneMatcher(const cv::Mat1b& image, Camera camera, std::span<const SourceView<Camera>> sources,
              const PatchMatchOptions& options,
              lanes::InstructionSet set = lanes::fastest_instruction_set());

  std::size_t views() const { return views_; }
  const PixelSampler<Camera>& pixels() const { return pixels_; }
  void rays(int x, int y, RayTile& tile) const { caster_.rays(x, y, tile); }

  // See Matcher::score. Precondition: at most lanes::kLanes planes.
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
