// SPDX-License-Identifier: GPL-3.0-or-later
// A correction of colours at the pixels of one chart.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

namespace axial::texture {

class ChartField {
 public:
  // Zero, without pixels.
  explicit ChartField(cv::Size size) : covered_(size, 0), value_(size, cv::Vec3f(0, 0, 0)) {}

  // Covers the pixels whose centres lie in a triangle, with values that are linear between its
  // corners. Positions are relative to the field. A pixel that is covered already stays.
  void add_triangle(const std::array<Eigen::Vector2f, 3>& corners,
                    const std::array<Eigen::Vector3f, 3>& values);

  // Covers the four pixels around a position, except those that are covered already.
  void add_point(const Eigen::Vector2f& at, const Eigen::Vector3f& value);

  // Covers the pixels beside covered ones, with the mean of the covered ones beside them.
  void widen();

  // A value to add at a position.
  struct Sample {
    Eigen::Vector2f at;
    Eigen::Vector3f value;
  };

  // Adds the solution of Laplace's equation in a strip of `width` pixels around the samples: near a
  // sample the mean of the samples nearest to the same pixel, zero beyond the strip, no flow
  // through the border of the covered pixels.
  void add_strip(std::span<const Sample> samples, int width);

  // Adds the field to `texture`, rounded, at the covered pixels.
  void add_to(cv::Mat3b texture) const;

 private:
  cv::Mat1b covered_;
  cv::Mat3f value_;
};

}  // namespace axial::texture
