// SPDX-License-Identifier: GPL-3.0-or-later
// Part of fuse(): the map of one view, and its comparison with the pixels of another view.
#pragma once

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "axial/cloud.h"
#include "scene/depth_map.h"

namespace axial::cloud {

// A depth map in the form that fusion needs: 20 bytes per pixel, 23 with colours. Points are not
// stored, because storing them costs more than computing them when they are needed. Pixels are
// addressed by y * width + x.
struct FusionMap {
  std::string image_path;
  Pose pose;
  CameraModel camera;    // at the resolution of the map
  cv::Mat1f depth;       // lambda (see DepthMap) [m]; 0: none
  cv::Mat3f normal;      // world frame; 0: unknown
  cv::Mat1f weight;      // 1 / (max(1 - confidence, 0.03) depth^2); 0 without depth
  cv::Mat3b color;       // B G R; empty without colours
  bool matched = false;  // the map has confidences

  // The number of pixels.
  std::size_t pixels() const { return depth.total(); }
  float depth_at(std::size_t pixel) const { return depth.ptr<float>()[pixel]; }
  float weight_at(std::size_t pixel) const { return weight.ptr<float>()[pixel]; }
  // The matching cost: 1 - confidence, limited to the range from 0.03 to 0.99 and recovered from
  // the weight. 1 if the map has no confidences. Precondition: the pixel has a depth.
  double cost_at(std::size_t pixel) const {
    if (!matched) return 1;
    const auto depth_here = static_cast<double>(depth_at(pixel));
    return std::min(0.99, 1 / (static_cast<double>(weight_at(pixel)) * depth_here * depth_here));
  }
  // The unit normal in the world frame. 0: unknown.
  Eigen::Vector3f normal_at(std::size_t pixel) const {
    return Eigen::Map<const Eigen::Vector3f>(normal.ptr<float>() + 3 * pixel);
  }
  // B G R. Precondition: `color` is not empty.
  cv::Vec3b color_at(std::size_t pixel) const { return color.ptr<cv::Vec3b>()[pixel]; }
};

// Makes a FusionMap of `map`: checks the map, rotates its normals into the world frame and computes
// the weights. A map without normals gets normals from its depths (estimate_map_normals()). A map
// without confidences gets the weights of the confidence 0. `color`: the image in B G R, or empty.
// Depths share memory with `map`, and colours with `color`, if their rows are contiguous. Throws an
// Error that names the map's image in two cases: the map is empty, or the camera, the normals, the
// confidences or `color` differ in size from the depths.
FusionMap make_fusion_map(DepthMap map, const cv::Mat3b& color);

// Some pixels of a view and their points in the world frame [m].
struct PixelPoints {
  std::vector<std::uint32_t> pixels;    // numbers y * width + x
  std::vector<Eigen::Vector3f> points;  // one per pixel, filled by back_project()
};

// Fills where.points with the points that the pixels where.pixels of `view` see. Precondition:
// every pixel has a depth.
void back_project(const FusionMap& view, PixelPoints& where);

// The result of comparing the point of a pixel with a neighbour's map. FuseOptions says which
// depths and normals count as the same.
//   - cannot see: the point is outside the neighbour's image, its map has no depth there, or the
//     depth of the neighbour's pixel is smaller, so that the point is hidden,
//   - differs: the neighbour's pixel has the same depth, but another normal,
//   - joins: the neighbour's pixel has the same depth and normal,
//   - contradicts: the depth of the neighbour's pixel is larger, so that the neighbour sees through
//     the point.
// The answers `joins` and `contradicts` contain the number of the neighbour's pixel, which must be
// below 2^31 - 1. An answer takes 4 bytes.
class Answer {
 public:
  Answer() = default;  // cannot see
  static Answer differs() { return Answer(kDiffers); }
  static Answer joins(std::uint32_t pixel) { return Answer(pixel << 1); }
  static Answer contradicts(std::uint32_t pixel) { return Answer(pixel << 1 | 1u); }

  bool cannot_see() const { return code_ == kCannotSee; }
  // True for `joins` and `contradicts`.
  bool names_pixel() const { return code_ < kDiffers; }
  // Precondition of agrees() and pixel(): names_pixel(). agrees() is true for `joins` and false for
  // `contradicts`.
  bool agrees() const { return (code_ & 1u) == 0; }
  std::uint32_t pixel() const { return code_ >> 1; }

 private:
  explicit Answer(std::uint32_t code) : code_(code) {}
  static constexpr std::uint32_t kDiffers = 0xFFFFFFFEu, kCannotSee = 0xFFFFFFFFu;
  std::uint32_t code_ = kCannotSee;
};

// Compares each point of `asking` with the map `neighbour`. `asking` holds pixels of `reference`
// and their points. Fills `answers` in the order of `asking`. `options`: depth_threshold and
// normal_threshold are used. Preconditions: `asking` and `answers` have the same length, and
// back_project() has filled the points. The answers do not depend on whether pixels are already
// used.
void ask_neighbour(const FusionMap& reference, const FusionMap& neighbour,
                   const PixelPoints& asking, const FuseOptions& options,
                   std::span<Answer> answers);

}  // namespace axial::cloud
