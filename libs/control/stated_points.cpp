// SPDX-License-Identifier: GPL-3.0-or-later
#include "private/stated_points.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/error.h"
#include "control/labels.h"
#include "private/coordinate_system.h"

namespace axial::control {
namespace {

constexpr double kMostLongitude = 360;  // longitudes from 0 to 360 occur, too

bool same_number(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

bool same_place(const StatedPoint& a, const StatedPoint& b) {
  for (int k = 0; k < 3; ++k)
    if (!same_number(a.place[k], b.place[k]) || !same_number(a.sigma[k], b.sigma[k])) return false;
  return true;
}

void check_point(const StatedPoint& point) {
  if (label_key(point.label).empty()) fail_in(point.where, "the label is empty");
  for (int k = 0; k < 3; ++k) {
    if (std::isinf(point.place[k]))
      fail_in(point.where, "{}: a coordinate is {}, which is not finite", point.label,
              point.place[k]);
    if (!(point.sigma[k] >= 0) || std::isinf(point.sigma[k]))
      fail_in(point.where, "{}: an accuracy is {}, but must be above 0", point.label,
              point.sigma[k]);
  }
  if (std::isnan(point.place.x()) != std::isnan(point.place.y()))
    fail_in(point.where, "{}: has only one of the two horizontal coordinates", point.label);
}

// Leaves one point of each label.
void remove_repetitions(std::vector<StatedPoint>& points) {
  std::map<std::string, StatedPoint> first;
  std::erase_if(points, [&](const StatedPoint& point) {
    check_point(point);
    const auto [known, is_new] = first.emplace(label_key(point.label), point);
    if (!is_new && !same_place(known->second, point))
      fail_in(point.where, "{} has another place or accuracy than at {}", point.label,
              known->second.where);
    return !is_new;
  });
}

void turn_depths(StatedPoints& stated, const std::string& file, Control& control) {
  const StatedPoint* below = nullptr;  // with a positive depth
  const StatedPoint* above = nullptr;
  for (const StatedPoint& point : stated.points) {
    if (!point.is_depth) continue;
    if (point.place.z() > 0 && !below) below = &point;
    if (point.place.z() < 0 && !above) above = &point;
  }
  if (below && above)
    fail_in(below->where, "{}: the depth is {}, but that of {} is {}; depths must have one sign",
            below->label, below->place.z(), above->label, above->place.z());
  if (below)
    for (StatedPoint& point : stated.points)
      if (point.is_depth) point.place.z() = 0 - point.place.z();
  if (below)
    control.notes.push_back(
        fmt::format("{}: depths are positive: their opposites are the heights", file));
  if (above)
    control.notes.push_back(fmt::format("{}: depths are negative: they are the heights", file));
}

CoordinateSystem system_of(const std::string& text, const std::string& where) {
  auto system = CoordinateSystem::from_text(text);
  if (!system) fail_in(where, "'{}' is no coordinate reference system that PROJ knows", text);
  return *std::move(system);
}

std::optional<CoordinateSystem> stated_system(const StatedPoints& stated) {
  if (stated.crs.empty()) {
    if (!stated.degrees) return {};
    return system_of("EPSG:4326", {});
  }
  auto system = system_of(stated.crs, stated.crs_where);
  if (stated.degrees && !system.is_geographic())
    fail_in(stated.crs_where, "the coordinates are longitude and latitude, but the system is {}",
            system.is_local() ? "local" : system.name());
  if (system.is_local() && !system.is_metric())
    fail_in(stated.crs_where, "the unit of the coordinates is not the metre");
  return system;
}

bool has_plane(const StatedPoint& point) {
  return !std::isnan(point.place.x());
}

// The zone of the mean, or nothing if no place is known.
std::optional<CoordinateSystem> zone_of(const StatedPoints& stated) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (const StatedPoint& point : stated.points)
    if (has_plane(point)) sum += point.place.head<2>(), ++count;
  if (count == 0) return {};
  sum /= count;
  return system_of(utm_zone(sum.x(), sum.y()), {});
}

void require_on_earth(const StatedPoints& stated) {
  constexpr double kPole = 90;
  for (const StatedPoint& point : stated.points)
    if (has_plane(point) &&
        (std::abs(point.place.x()) > kMostLongitude || std::abs(point.place.y()) > kPole))
      fail_in(point.where, "{}: longitude {} and latitude {} are not on the Earth", point.label,
              point.place.x(), point.place.y());
}

void transform(StatedPoints& stated, const CoordinateSystem& from, const CoordinateSystem& to) {
  std::vector<Eigen::Vector2d> places;
  for (const StatedPoint& point : stated.points)
    if (has_plane(point)) places.emplace_back(point.place.head<2>());
  const std::vector<Eigen::Vector2d> there = transformed(places, from, to);
  std::size_t next = 0;
  for (StatedPoint& point : stated.points) {
    if (!has_plane(point)) continue;
    if (!there[next].allFinite())
      fail_in(point.where, "{}: {} {} has no place in {}", point.label, point.place.x(),
              point.place.y(), to.name());
    point.place.head<2>() = there[next++];
  }
}

CoordinateSystem system_of_epsg(int epsg, const std::string& file) {
  auto system = system_of(fmt::format("EPSG:{}", epsg), file);
  if (!system.is_metric() || system.is_local())
    fail_in(file, "EPSG:{} is no projected coordinate reference system with metres as unit", epsg);
  return system;
}

// Returns the name of the system of the points, which are in metres afterwards.
std::string to_metres(StatedPoints& stated, const std::string& file, int epsg, Control& control) {
  const auto from = stated_system(stated);
  auto to = epsg ? std::optional(system_of_epsg(epsg, file)) : std::nullopt;
  if (!from || from->is_local()) {
    if (to)
      control.notes.push_back(
          fmt::format("{}: the system of the coordinates is not stated; they are taken as {}", file,
                      to->name()));
    return to ? to->name() : "";
  }
  if (from->is_geographic()) {
    require_on_earth(stated);
    if (!to) to = zone_of(stated);
  }
  if (!to) {
    if (!from->is_geographic() && !from->is_metric())
      fail_in(stated.crs_where,
              "the unit of {} is not the metre; give the code of a system in metres", from->name());
    return from->is_geographic() ? "" : from->name();
  }
  if (to->name() == from->name()) return to->name();
  transform(stated, *from, *to);
  control.notes.push_back(
      fmt::format("{}: {} were converted to metres, {}; heights are unchanged", file,
                  from->is_geographic() ? "longitude and latitude" : "coordinates", to->name()));
  return to->name();
}

ControlPoint control_point(const StatedPoint& stated, double default_sigma) {
  ControlPoint point;
  point.label = stated.label;
  point.check = stated.check;
  point.where = stated.where;
  for (int k = 0; k < 3; ++k) {
    if (std::isnan(stated.place[k])) continue;
    point.metres[k] = stated.place[k];
    point.sigma[k] = stated.sigma[k] > 0 ? stated.sigma[k] : default_sigma;
  }
  return point;
}

bool lacks_sigma(const StatedPoint& point) {
  for (int k = 0; k < 3; ++k)
    if (!std::isnan(point.place[k]) && !(point.sigma[k] > 0)) return true;
  return false;
}

}  // namespace

double finite(double value, const std::string& where, const std::string& field) {
  if (!std::isfinite(value)) fail_in(where, "{} is {}, which is not finite", field, value);
  return value;
}

void add_points(StatedPoints stated, const std::filesystem::path& file,
                const ControlReading& options, Control& control) {
  remove_repetitions(stated.points);
  if (stated.points.empty()) return;
  turn_depths(stated, file.string(), control);
  control.crs = to_metres(stated, file.string(), options.epsg, control);
  for (const StatedPoint& point : stated.points)
    control.points.push_back(control_point(point, options.point_sigma));
  if (const auto count = std::ranges::count_if(stated.points, lacks_sigma))
    control.notes.push_back(fmt::format("{}: {} points state no accuracy: {} m is taken",
                                        file.string(), count, options.point_sigma));
}

void add_bar(Bar bar, const ControlReading& options, Control& control) {
  if (label_key(bar.first).empty() || label_key(bar.second).empty())
    fail_in(bar.where, "the label of a target is empty");
  const std::string name = name_of(bar);
  if (same_label(bar.first, bar.second)) fail_in(bar.where, "{}: both targets are the same", name);
  if (!(bar.metres > 0) || std::isinf(bar.metres))
    fail_in(bar.where, "{}: the length {} m must be above 0", name, bar.metres);
  if (!(bar.sigma >= 0) || std::isinf(bar.sigma))
    fail_in(bar.where, "{}: the accuracy {} m must be above 0", name, bar.sigma);
  if (bar.sigma == 0) bar.sigma = options.bar_sigma;
  for (const Bar& other : control.bars) {
    if (!same_targets(bar, other)) continue;
    if (other.metres == bar.metres && other.sigma == bar.sigma) return;
    fail_in(bar.where, "{} has another length or accuracy than at {}", name, other.where);
  }
  control.bars.push_back(std::move(bar));
}

}  // namespace axial::control
