// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "cameras/private/position_parts.h"

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

struct UtmZone {
  int number = 0;  // 1 to 60
  bool south = false;

  int epsg() const { return (south ? 32700 : 32600) + number; }
  std::string name() const {
    return fmt::format("WGS 84 / UTM zone {}{}", number, south ? 'S' : 'N');
  }
};

// The zone of a place, by the regular division into stripes of six degrees.
UtmZone utm_zone(double longitude, double latitude) {
  const double turned = longitude - 360 * std::floor((longitude + 180) / 360);  // -180 to 180
  return {std::clamp(static_cast<int>(std::floor((turned + 180) / 6)) + 1, 1, 60), latitude < 0};
}

// Easting and northing [m] of a place. Arguments in degrees, latitude from -84 to 84, longitude
// within a few degrees of the zone (the error is below 0.001 mm within 10 degrees). Formula:
// Krüger's series to the fourth order in n (C. F. F. Karney, Transverse Mercator with an accuracy
// of a few nanometers, Journal of Geodesy 85, 2011, equations 7 to 12 and 35).
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

constexpr double kMostLatitude = 84;    // of UTM
constexpr double kMostLongitude = 360;  // longitudes from 0 to 360 occur, too

struct Box {
  Eigen::Array2d low = Eigen::Array2d::Constant(INFINITY), high = -low;

  Eigen::Array2d size() const { return high - low; }
  Eigen::Array2d farthest_from_zero() const { return low.abs().max(high.abs()); }
};

Box box_of(std::span<const Eigen::Vector3d> positions) {
  Box box;
  for (const Eigen::Vector3d& position : positions) {
    box.low = box.low.min(position.head<2>().array());
    box.high = box.high.max(position.head<2>().array());
  }
  return box;
}

}  // namespace

bool is_lost_fix(const Eigen::Vector3d& position) {
  return position.x() == 0 && position.y() == 0;
}

std::string words_for(DegreeOrder order) {
  return order == DegreeOrder::longitude_first ? "longitude and latitude in degrees"
                                               : "latitude and longitude in degrees";
}

std::vector<DegreeOrder> possible_orders(std::span<const Eigen::Vector3d> positions,
                                         bool longitude_first) {
  if (longitude_first) return {DegreeOrder::longitude_first};
  const Eigen::Array2d farthest = box_of(positions).farthest_from_zero();
  constexpr double kPole = 90;
  std::vector<DegreeOrder> orders;
  if (farthest.x() <= kMostLongitude && farthest.y() <= kPole)
    orders.push_back(DegreeOrder::longitude_first);
  if (farthest.y() <= kMostLongitude && farthest.x() <= kPole)
    orders.push_back(DegreeOrder::latitude_first);
  return orders;
}

std::vector<DegreeOrder> orders_without_unit(std::span<const Eigen::Vector3d> positions,
                                             bool longitude_first) {
  constexpr double kWidest = 0.1, kFarFromZero = 1;
  if (positions.size() < 3) return {};
  const Box box = box_of(positions);
  const Eigen::Array2d farthest = box.farthest_from_zero();
  const double width = box.size().maxCoeff();
  if (!(width > 0) || width > kWidest || farthest.maxCoeff() <= kFarFromZero) return {};
  std::vector<DegreeOrder> orders = possible_orders(positions, longitude_first);
  std::erase_if(orders, [&](DegreeOrder order) {
    const Eigen::Index longitude = order == DegreeOrder::longitude_first ? 0 : 1;
    return farthest[longitude] > kMostLongitude || farthest[1 - longitude] > kMostLatitude;
  });
  return orders;
}

PositionReading read_as_degrees(std::span<const Eigen::Vector3d> positions, DegreeOrder order,
                                const std::string& file, std::span<const int> lines) {
  PositionReading reading{words_for(order), {}, {positions.begin(), positions.end()}};
  if (order == DegreeOrder::latitude_first)
    for (Eigen::Vector3d& position : reading.positions) std::swap(position.x(), position.y());
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector3d& position : reading.positions)
    mean += position.head<2>() / static_cast<double>(positions.size());
  const UtmZone zone = utm_zone(mean.x(), mean.y());
  for (std::size_t i = 0; i < reading.positions.size(); ++i) {
    const double longitude = reading.positions[i].x(), latitude = reading.positions[i].y();
    if (std::abs(latitude) > kMostLatitude || std::abs(longitude - mean.x()) > 10)
      fail("{}:{}: longitude {} and latitude {} are not in a UTM zone with the others; {}", file,
           lines[i], longitude, latitude, kProjectRemedy);
    reading.positions[i].head<2>() = to_utm(longitude, latitude, zone);
  }
  reading.note = fmt::format(
      "longitude and latitude in degrees were converted to metres, {} (EPSG:{}); heights are "
      "unchanged",
      zone.name(), zone.epsg());
  return reading;
}

}  // namespace axial::io
