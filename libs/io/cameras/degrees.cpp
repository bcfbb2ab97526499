// SPDX-License-Identifier: GPL-3.0-or-later
#include "private/cameras/degrees.h"

#include <cmath>

#include "base/error.h"
#include "private/cameras/utm.h"

namespace axial::io {
namespace {

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
