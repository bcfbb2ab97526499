// SPDX-License-Identifier: GPL-3.0-or-later
// A correction of colours at the pixels of one chart.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

namespace axial::texture {

// A field of corrections [grey levels, B G R]. The field has a value at each pixel that it covers.
// Positions are (x, y) [px] relative to the field's upper left pixel, with pixel centres at
// integers.
class ChartField {
 public:
  // The field covers no pixel at first.
  explicit ChartField(cv::Size size) : covered_(size, 0), value_(size, cv::Vec3f(0, 0, 0)) {}

  // Covers the pixels whose centres lie in a triangle or on its edges. `values` are the values at
  // `corners`, and the values between the corners are linear. A pixel that is already covered keeps
  // its value. A triangle without area covers nothing.
  void add_triangle(const std::array<Eigen::Vector2f, 3>& corners,
                    const std::array<Eigen::Vector3f, 3>& values);

  // Covers the four pixels around a position with `value`. A pixel that is already covered keeps
  // its value.
  void add_point(const Eigen::Vector2f& at, const Eigen::Vector3f& value);

  // Covers each uncovered pixel that has at least one covered pixel among its eight neighbours. The
  // value of the new pixel is the mean of the values of its covered neighbours.
  void widen();

  // A value to add at a position.
  struct Sample {
    Eigen::Vector2f at;
    Eigen::Vector3f value;
  };

  // Adds the solution of Laplace's equation to the values in a strip. The strip consists of the
  // covered pixels that fewer than `width` steps reach from the pixel of a sample, which is the
  // pixel nearest to the sample. A step leads from a covered pixel to a covered pixel above, below,
  // left or right of it. Samples whose pixel is not covered are ignored. The solution has these
  // boundary conditions:
  //   - At a pixel with samples, the solution is the mean of the samples.
  //   - At covered pixels beyond the strip, the solution is zero.
  //   - There is no flow through the border of the covered pixels.
  // The solution is approximate, by a fixed number of iterations.
  void add_strip(std::span<const Sample> samples, int width);

  // Adds the field to `texture` at the covered pixels. The sums are rounded, and limited to 0 to
  // 255. `texture` is the part of a texture that the field corrects, and has the field's size.
  void add_to(cv::Mat3b texture) const;

 private:
  cv::Mat1b covered_;
  cv::Mat3f value_;
};

// The memory [bytes] of a field of `pixels` pixels, all of which are in a strip while the strip is
// added.
std::uint64_t bytes_of_field(std::uint64_t pixels);

}  // namespace axial::texture
