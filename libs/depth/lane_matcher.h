// SPDX-License-Identifier: GPL-3.0-or-later
// The matcher in SIMD lanes: exact projection and affine warp, for pinholes and both kinds of port,
// with straight and with distorted lenses. Only source views share lanes, and only those of one
// kind of camera: the reference view, of which lanes get nothing but rays, may be of another.
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
  // Images and depth maps of the sources, at most kMaxSources, are copied. Error if those of one
  // kind of camera have 2^31 pixels or more together.
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
  // Up to lanes::kLanes source views of one kind of camera.
  struct Group {
    std::unique_ptr<const lanes::SceneTables> tables;
    std::unique_ptr<const lanes::Scorer> scorer;
  };

  struct Place {
    std::uint8_t group, lane;
  };

  PixelSampler<Camera> pixels_;
  RayCaster<Camera> caster_;
  std::size_t views_;
  std::vector<Group> groups_;
  std::array<Place, kMaxSources> places_{};  // of the source views
};

}  // namespace axial::depth
