// SPDX-License-Identifier: GPL-3.0-or-later
#include "private/cameras/utm.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace axial::io {
namespace {

constexpr double kEquator = 6378137, kFlattening = 1 / 298.257223563;  // of WGS 84
constexpr double kN = kFlattening / (2 - kFlattening);
constexpr double kScale = 0.9996, kEasting = 500000, kNorthingSouth = 10000000;

constexpr std::array<double, 4> kSeries{
    kN / 2 - 2 * kN * kN / 3 + 5 * kN * kN * kN / 16 + 41 * kN * kN * kN * kN / 180,
    13 * kN* kN / 48 - 3 * kN* kN* kN / 5 + 557 * kN* kN* kN* kN / 1440,
    61 * kN* kN* kN / 240 - 103 * kN* kN* kN* kN / 140, 49561 * kN* kN* kN* kN / 161280};

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

}  // namespace

std::string UtmZone::name() const {
  return fmt::format("WGS 84 / UTM zone {}{}", number, south ? 'S' : 'N');
}

UtmZone utm_zone(double longitude, double latitude) {
  const double turned = longitude - 360 * std::floor((longitude + 180) / 360);  // -180 to 180
  return {std::clamp(static_cast<int>(std::floor((turned + 180) / 6)) + 1, 1, 60), latitude < 0};
}

Eigen::Vector2d to_utm(double longitude, double latitude, const UtmZone& zone) {
  const double lambda = radians(longitude - (6.0 * zone.number - 183));
  const double sine = std::sin(radians(latitude));
  const double eccentricity = 2 * std::sqrt(kN) / (1 + kN);
  const double tangent =
      std::sinh(std::atanh(sine) - eccentricity * std::atanh(eccentricity * sine));
  const double xi = std::atan2(tangent, std::cos(lambda));
  const double eta = std::asinh(std::sin(lambda) / std::hypot(tangent, std::cos(lambda)));
  Eigen::Vector2d place(eta, xi);
  for (std::size_t j = 0; j < kSeries.size(); ++j) {
    const double k = 2.0 * static_cast<double>(j + 1);
    place.x() += kSeries[j] * std::cos(k * xi) * std::sinh(k * eta);
    place.y() += kSeries[j] * std::sin(k * xi) * std::cosh(k * eta);
  }
  const double radius = kEquator / (1 + kN) * (1 + kN * kN / 4 + kN * kN * kN * kN / 64);
  return kScale * radius * place + Eigen::Vector2d(kEasting, zone.south ? kNorthingSouth : 0);
}

}  // namespace axial::io
