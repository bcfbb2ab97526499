// SPDX-License-Identifier: GPL-3.0-or-later
// The matcher in SIMD lanes: exact projection and affine warp, for pinholes and both kinds of port,
// with straight and with distorted lenses.
#pragma once

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
  // Images and depth maps of the sources are copied. Error if they have 2^31 pixels or more
  // together.
  LaneMatcher(const cv::Mat1b& image, Camera camera, std::span<const SourceView<Camera>> sources,
              const PatchMatchOptions& options,
              lanes::InstructionSet set = lanes::fastest_instruction_set());

  std::size_t views() const { return views_; }
  const PixelSampler<Camera>& pixels() const { return pixels_; }
  void rays(int x, int y, RayTile& tile) const { caster_.rays(x, y, tile); }

  // As Matcher::score. Precondition: at most lanes::kLanes planes.
  void score(const ReferencePixel& pixel, std::span<const PlaneHypothesis> planes,
             std::span<const ScorePair> pairs, std::span<const SurfacePoint> neighbours,
             std::span<ViewScore> scores) const;

 private:
  // Up to lanes::kLanes source views.
  struct Group {
    std::unique_ptr<const lanes::SceneTables> tables;
    std::unique_ptr<const lanes::Scorer> scorer;
  };

  PixelSampler<Camera> pixels_;
  RayCaster<Camera> caster_;
  std::size_t views_;
  std::vector<Group> groups_;
};

}  // namespace axial::depth
