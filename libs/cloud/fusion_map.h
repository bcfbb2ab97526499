// SPDX-License-Identifier: GPL-3.0-or-later
// Inside of fuse(): one view's map, and what it answers to another view.
#pragma once

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "cloud/fuse.h"

namespace axial::cloud {

// A depth map as fusion needs it: 20 bytes a pixel, and 3 with colours. Points are computed when
// needed, which is cheaper than to keep them. Pixels are addressed by y * width + x.
struct FusionMap {
  std::string image_path;
  Pose pose;
  CameraModel camera;
  cv::Mat1f depth;       // 0: none
  cv::Mat3f normal;      // world frame; 0: unknown
  cv::Mat1f weight;      // 1 / (max(1 - confidence, 0.03) depth^2); meaningless without depth
  cv::Mat3b color;       // may be empty
  bool matched = false;  // the map has confidences

  std::size_t pixels() const { return depth.total(); }
  float depth_at(std::size_t pixel) const { return depth.ptr<float>()[pixel]; }
  float weight_at(std::size_t pixel) const { return weight.ptr<float>()[pixel]; }
  // Of matching, 1 - confidence, from 0.03 to 0.99: what the weight was made of. 1: not known.
  double cost_at(std::size_t pixel) const {
    if (!matched) return 1;
    const auto depth_here = static_cast<double>(depth_at(pixel));
    return std::min(0.99, 1 / (static_cast<double>(weight_at(pixel)) * depth_here * depth_here));
  }
  Eigen::Vector3f normal_at(std::size_t pixel) const {
    return Eigen::Map<const Eigen::Vector3f>(normal.ptr<float>() + 3 * pixel);
  }
  cv::Vec3b color_at(std::size_t pixel) const { return color.ptr<cv::Vec3b>()[pixel]; }
};

// Checks the map (Error that names its image) and turns its normals into the world. Shares depths
// and colours with what it is given.
FusionMap make_fusion_map(DepthMap map, const cv::Mat3b& color);

// Some pixels of a view and their points in the world.
struct PixelPoints {
  std::vector<std::uint32_t> pixels;
  std::vector<Eigen::Vector3f> points;  // as many, once back_project has filled them
};

// Fills the points; every pixel must have a depth.
void back_project(const FusionMap& view, PixelPoints& where);

// What a neighbour says to a pixel: "I cannot see you" (the point is outside the image, hidden, or
// the map has no depth there), "my pixel has your depth, but another normal", "my pixel sees the
// same", or "my pixel sees through you".
class Answer {
 public:
  Answer() = default;  // cannot see
  static Answer differs() { return Answer(kDiffers); }
  static Answer joins(std::uint32_t pixel) { return Answer(pixel << 1); }
  static Answer contradicts(std::uint32_t pixel) { return Answer(pixel << 1 | 1u); }

  bool cannot_see() const { return code_ == kCannotSee; }
  bool names_pixel() const { return code_ < kDiffers; }
  // Of an answer that names a pixel.
  bool agrees() const { return (code_ & 1u) == 0; }
  std::uint32_t pixel() const { return code_ >> 1; }

 private:
  explicit Answer(std::uint32_t code) : code_(code) {}
  static constexpr std::uint32_t kDiffers = 0xFFFFFFFEu, kCannotSee = 0xFFFFFFFFu;
  std::uint32_t code_ = kCannotSee;
};

// The answers of `neighbour` to the pixels `asking` of `reference`, in that order; `answers` has
// that length too. They do not depend on which pixels are used already.
void ask_neighbour(const FusionMap& reference, const FusionMap& neighbour,
                   const PixelPoints& asking, const FuseOptions& options,
                   std::span<Answer> answers);

}  // namespace axial::cloud
