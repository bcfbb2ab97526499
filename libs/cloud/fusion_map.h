// SPDX-License-Identifier: GPL-3.0-or-later
// Inside of fuse(): one view's map in world coordinates, and what it answers to another view.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "cloud/fuse.h"

namespace axial::cloud {

// A depth map back-projected once. Pixels are addressed by y * width + x.
struct FusionMap {
  DepthMap map;
  cv::Mat3b color;                      // may be empty
  std::vector<Eigen::Vector3f> point;   // world; meaningless where depth is 0
  std::vector<Eigen::Vector3f> normal;  // world; 0: unknown; empty: none at all
  std::vector<float> weight;            // 1 / (max(1 - confidence, 0.03) depth^2)

  std::size_t pixels() const { return point.size(); }
  float depth(std::size_t pixel) const { return map.depth.ptr<float>()[pixel]; }
  cv::Vec3b color_at(std::size_t pixel) const { return color.ptr<cv::Vec3b>()[pixel]; }
};

// Checks the map (Error that names its image) and back-projects it.
FusionMap make_fusion_map(DepthMap map, cv::Mat3b color);

// What a neighbour says to a pixel: nothing, "my pixel sees the same", or "my pixel sees through
// you".
class Answer {
 public:
  Answer() = default;
  static Answer joins(std::uint32_t pixel) { return Answer(pixel << 1); }
  static Answer contradicts(std::uint32_t pixel) { return Answer(pixel << 1 | 1u); }

  bool none() const { return code_ == kNone; }
  bool agrees() const { return (code_ & 1u) == 0; }
  std::uint32_t pixel() const { return code_ >> 1; }

 private:
  explicit Answer(std::uint32_t code) : code_(code) {}
  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  std::uint32_t code_ = kNone;
};

// The answers of `neighbour` to the pixels `asking` of `reference`, in that order; `answers` has
// that length too. They do not depend on which pixels are used already.
void ask_neighbour(const FusionMap& reference, const FusionMap& neighbour,
                   std::span<const std::uint32_t> asking, const FuseOptions& options,
                   std::span<Answer> answers);

}  // namespace axial::cloud
