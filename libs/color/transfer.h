// SPDX-License-Identifier: GPL-3.0-or-later
// From the values of photographs to light, and back.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace axial::color {

// How a camera maps light to values, both from 0 to 1.
class Transfer {
 public:
  // The curve of sRGB (IEC 61966-2-1).
  Transfer() = default;

  // "srgb", "linear", or "gamma:G", value = light^(1/G) with G from 0.2 to 5. Throws an Error for
  // another text.
  static Transfer parse(std::string_view text);

  // value = light^(1/G). Precondition: G is within the range of parse().
  static Transfer of_gamma(double gamma);

  // G; empty for the curve of sRGB.
  std::optional<double> gamma() const;

  // The text of parse(); G has four digits.
  std::string name() const;

  float light(float value) const;  // of a value; values outside 0 to 1 are clamped
  float value(float light) const;  // of light, the inverse of light()
  float slope(float value) const;  // d(light)/d(value), at least 1e-3

 private:
  double gamma_ = 0;  // 0: sRGB; 1: linear
};

// The light of a photograph: R G B, 0 to 1. `pixels`: B G R of 8 or 16 bits. `bits`: of a value of
// 16 bits (8 to 16).
cv::Mat3f light_of(const cv::Mat& pixels, int bits, const Transfer& transfer);

// The light from which on a channel counts as clipped: that of 98 % of the largest value.
float clipped_light(const Transfer& transfer);

// Sets clipped channels to NaN, and pixels where `mask` is 0 (an empty mask: nowhere).
void mark_unusable(cv::Mat3f& light, const cv::Mat1b& mask, const Transfer& transfer);

}  // namespace axial::color
