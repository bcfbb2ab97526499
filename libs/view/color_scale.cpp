// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/color_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/order_statistics.h"

namespace axial::view {
namespace {

// Matplotlib's "viridis", "mako"-like and "inferno", sampled coarsely.
const cv::Vec3b kViolet[] = {{68, 1, 84},    {71, 44, 122},  {59, 81, 139},
                             {44, 113, 142}, {33, 144, 141}, {39, 173, 129},
                             {92, 200, 99},  {170, 220, 50}, {253, 231, 37}};
const cv::Vec3b kGreen[] = {{60, 20, 60},   {52, 58, 115},   {45, 105, 150},
                            {60, 150, 150}, {110, 195, 150}, {215, 240, 205}};
const cv::Vec3b kLight[] = {{28, 16, 68},   {79, 18, 123},  {129, 37, 129},  {181, 54, 122},
                            {229, 80, 100}, {251, 135, 97}, {254, 194, 135}, {252, 253, 191}};
const cv::Vec3b kDiverging[] = {{166, 54, 3},    {230, 120, 50}, {253, 190, 133}, {205, 205, 205},
                                {158, 202, 225}, {66, 130, 190}, {8, 64, 140}};

std::uint8_t byte_of(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

}  // namespace

std::span<const cv::Vec3b> violet_to_yellow() {
  return kViolet;
}
std::span<const cv::Vec3b> dark_to_green() {
  return kGreen;
}
std::span<const cv::Vec3b> dark_to_light() {
  return kLight;
}
std::span<const cv::Vec3b> orange_to_blue() {
  return kDiverging;
}

ColorScale scale_of(std::span<const cv::Vec3b> colors, double low, double high) {
  return {{colors.begin(), colors.end()}, low, high};
}

cv::Vec3b color_of(const ColorScale& scale, double value) {
  const auto last = static_cast<double>(scale.colors.size() - 1);
  const double width = scale.high - scale.low;
  const double share = width > 0 ? std::clamp((value - scale.low) / width, 0.0, 1.0) : 0.5;
  const auto below = static_cast<std::size_t>(std::min(share * last, std::max(last - 1, 0.0)));
  const cv::Vec3b& a = scale.colors[below];
  const cv::Vec3b& b = scale.colors[std::min(below + 1, scale.colors.size() - 1)];
  const double part = share * last - static_cast<double>(below);
  cv::Vec3b color;
  for (int k = 0; k < 3; ++k) color[k] = byte_of(a[k] + part * (b[k] - a[k]));
  return color;
}

std::string css_color(const cv::Vec3b& color) {
  return fmt::format("#{:02x}{:02x}{:02x}", color[0], color[1], color[2]);
}

std::pair<double, double> quantiles(const cv::Mat1f& values, double low, double high) {
  std::vector<float> known;
  for (const float value : values)
    if (!std::isnan(value)) known.push_back(value);
  const double first = lower_quantile(known, low);
  return {first, lower_quantile(std::move(known), high)};
}

cv::Mat3b painted(const cv::Mat1f& values, const ColorScale& scale, const cv::Mat1b& shades) {
  cv::Mat3b picture(values.size());
  for (int y = 0; y < values.rows; ++y)
    for (int x = 0; x < values.cols; ++x) {
      const bool is_known = !std::isnan(values(y, x));
      const cv::Vec3b color = is_known ? color_of(scale, values(y, x)) : kNothing;
      const double light = is_known && !shades.empty() ? shades(y, x) / 255.0 : 1;
      for (int k = 0; k < 3; ++k) picture(y, x)[k] = byte_of(light * color[2 - k]);
    }
  return picture;
}

}  // namespace axial::view
