// SPDX-License-Identifier: GPL-3.0-or-later
#include "color/transfer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/error.h"
#include "base/parse_number.h"
#include "base/srgb.h"

namespace axial::color {

Transfer Transfer::parse(std::string_view text) {
  constexpr std::string_view kGamma = "gamma:";
  if (text == "srgb") return {};
  if (text == "linear") return of_gamma(1);
  const auto gamma =
      text.starts_with(kGamma) ? parse_finite<double>(text.substr(kGamma.size())) : std::nullopt;
  if (!gamma || *gamma < 0.2 || *gamma > 5)
    fail("curve is '{}', but must be srgb, linear or gamma:G with G from 0.2 to 5", text);
  return of_gamma(*gamma);
}

Transfer Transfer::of_gamma(double gamma) {
  Transfer transfer;
  transfer.gamma_ = gamma;
  return transfer;
}

std::optional<double> Transfer::gamma() const {
  return gamma_ > 0 ? std::optional(gamma_) : std::nullopt;
}

std::string Transfer::name() const {
  if (gamma_ == 0) return "srgb";
  return gamma_ == 1 ? "linear" : fmt::format("gamma:{:.4g}", gamma_);
}

float Transfer::light(float value) const {
  const double v = std::clamp(value, 0.0f, 1.0f);
  if (gamma_ > 0) return static_cast<float>(std::pow(v, gamma_));
  return static_cast<float>(light_of_srgb(v));
}

float Transfer::value(float light) const {
  const double l = std::clamp(light, 0.0f, 1.0f);
  if (gamma_ > 0) return static_cast<float>(std::pow(l, 1 / gamma_));
  return static_cast<float>(srgb_of_light(l));
}

float Transfer::slope(float value) const {
  constexpr float kStep = 1e-3f;
  const float low = std::max(0.0f, value - kStep), high = std::min(1.0f, value + kStep);
  return std::max(1e-3f, (light(high) - light(low)) / (high - low));
}

cv::Mat3f light_of(const cv::Mat& pixels, int bits, const Transfer& transfer) {
  const bool bytes = pixels.depth() == CV_8U;
  const std::size_t values = std::size_t{1} << (bytes ? 8 : bits);
  std::vector<float> table(values);
  for (std::size_t i = 0; i < values; ++i)
    table[i] = transfer.light(static_cast<float>(i) / static_cast<float>(values - 1));
  cv::Mat3f light(pixels.size());
  for (int y = 0; y < pixels.rows; ++y)
    for (int x = 0; x < pixels.cols; ++x)
      for (int k = 0; k < 3; ++k) {
        const std::size_t value =
            bytes ? pixels.at<cv::Vec3b>(y, x)[k] : pixels.at<cv::Vec3w>(y, x)[k];
        light(y, x)[2 - k] = table[std::min(value, values - 1)];
      }
  return light;
}

float clipped_light(const Transfer& transfer) {
  return transfer.light(0.98f);
}

void mark_unusable(cv::Mat3f& light, const cv::Mat1b& mask, const Transfer& transfer) {
  constexpr float kUnusable = std::numeric_limits<float>::quiet_NaN();
  const float clipped = clipped_light(transfer);
  for (int y = 0; y < light.rows; ++y)
    for (int x = 0; x < light.cols; ++x) {
      const bool left_out = !mask.empty() && mask(y, x) == 0;
      for (int k = 0; k < 3; ++k)
        if (left_out || light(y, x)[k] >= clipped) light(y, x)[k] = kUnusable;
    }
}

}  // namespace axial::color
