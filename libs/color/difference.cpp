// SPDX-License-Identifier: GPL-3.0-or-later
#include "color/difference.h"

#include <cmath>
#include <numbers>

namespace axial::color {

std::array<double, 3> lab_of(const Eigen::Array3f& rgb) {
  const auto curve = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16 / 116.0; };
  const double x = 0.412453 * rgb[0] + 0.357580 * rgb[1] + 0.180423 * rgb[2];
  const double y = 0.212671 * rgb[0] + 0.715160 * rgb[1] + 0.072169 * rgb[2];
  const double z = 0.019334 * rgb[0] + 0.119193 * rgb[1] + 0.950227 * rgb[2];
  const double fx = curve(x / 0.950456), fy = curve(y), fz = curve(z / 1.088754);
  return {116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)};
}

double ciede2000(const std::array<double, 3>& first, const std::array<double, 3>& second) {
  constexpr double kPi = std::numbers::pi;
  const auto [l1, a1, b1] = first;
  const auto [l2, a2, b2] = second;
  const double mean_c = (std::hypot(a1, b1) + std::hypot(a2, b2)) / 2;
  const auto chroma_weight = [](double c) {
    return std::sqrt(std::pow(c, 7) / (std::pow(c, 7) + std::pow(25.0, 7)));
  };
  const double g = 0.5 * (1 - chroma_weight(mean_c));
  const double c1 = std::hypot((1 + g) * a1, b1), c2 = std::hypot((1 + g) * a2, b2);
  const auto hue = [](double b, double a) {
    const double h = std::atan2(b, a);
    return h < 0 ? h + 2 * kPi : h;
  };
  const double h1 = hue(b1, (1 + g) * a1), h2 = hue(b2, (1 + g) * a2);
  double turn = c1 * c2 == 0 ? 0 : h2 - h1;
  if (turn > kPi) turn -= 2 * kPi;
  if (turn < -kPi) turn += 2 * kPi;
  const double dl = l2 - l1, dc = c2 - c1, dh = 2 * std::sqrt(c1 * c2) * std::sin(turn / 2);
  double h = h1 + h2;
  if (c1 * c2 != 0) {
    if (std::abs(h1 - h2) > kPi) h += h < 2 * kPi ? 2 * kPi : -2 * kPi;
    h /= 2;
  }
  const double t = 1 - 0.17 * std::cos(h - kPi / 6) + 0.24 * std::cos(2 * h) +
                   0.32 * std::cos(3 * h + kPi / 30) - 0.20 * std::cos(4 * h - 63 * kPi / 180);
  const double l = (l1 + l2) / 2, c = (c1 + c2) / 2;
  const double sl = 1 + 0.015 * (l - 50) * (l - 50) / std::sqrt(20 + (l - 50) * (l - 50));
  const double sc = 1 + 0.045 * c, sh = 1 + 0.015 * c * t;
  const double degrees = (h * 180 / kPi - 275) / 25;
  const double rt = -2 * chroma_weight(c) * std::sin(kPi / 3 * std::exp(-degrees * degrees));
  const double tl = dl / sl, tc = dc / sc, th = dh / sh;
  return std::sqrt(tl * tl + tc * tc + th * th + rt * tc * th);
}

}  // namespace axial::color
