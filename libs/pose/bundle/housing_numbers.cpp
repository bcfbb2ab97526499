// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/bundle/housing_numbers.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace axial::pose {
namespace {

using Flat = refractive::FlatPort<double>;
using Dome = refractive::DomePort<double>;

constexpr double kDegrees = 180 / std::numbers::pi;

// A number of one kind of port. PortKind::none: of all kinds.
struct NumberRow {
  PortKind kind;
  int number;
  Quantity quantity;
  const char *name, *title, *unit;
  double scale;
};

constexpr NumberRow kNumberRows[] = {
    {PortKind::flat, 0, Quantity::angle, "normal to the right", "normal to the right", "degrees",
     kDegrees},
    {PortKind::flat, 1, Quantity::angle, "normal downwards", "normal downwards", "degrees",
     kDegrees},
    {PortKind::flat, 2, Quantity::distance, "distance", "distance of the port", "mm", 1e3},
    {PortKind::dome, 0, Quantity::coordinate, "centre x", "x of the dome's centre", "mm", 1e3},
    {PortKind::dome, 1, Quantity::coordinate, "centre y", "y of the dome's centre", "mm", 1e3},
    {PortKind::dome, 2, Quantity::coordinate, "centre z", "z of the dome's centre", "mm", 1e3},
    {PortKind::none, kIndexNumber, Quantity::index, "index of water", "index of the water", "", 1},
    {PortKind::none, kThicknessNumber, Quantity::thickness, "thickness", "thickness of the glass",
     "mm", 1e3}};

// The value of one of the first three numbers, in the unit of housing_change.h.
double place_value(const Flat& port, int number) {
  return number == 2 ? port.distance : std::atan2(port.normal[number], port.normal.z());
}

double place_value(const Dome& port, int number) {
  return port.centre[number];
}

double value_of(const refractive::Port<double>& port, int number) {
  return std::visit(
      [&](const auto& kind) {
        if (number == kIndexNumber) return kind.n_water;
        if (number == kThicknessNumber) return kind.thickness;
        return place_value(kind, number);
      },
      port);
}

constexpr NumberGroup kGroups[] = {
    {"normal", "normal_sigma", "normal of the port", &Sigmas::normal_degrees, 1 / kDegrees, 0, 2,
     true, false, false},
    {"distance", "distance_sigma", "", &Sigmas::distance, 1, 2, 1, true, false, false},
    {"centre", "centre_sigma", "centre of the dome", &Sigmas::centre, 1, 0, 3, false, true, false},
    {"thickness", "thickness_sigma", "", &Sigmas::thickness, 1, kThicknessNumber, 1, true, true,
     false},
    {"index", "index_sigma", "", &Sigmas::index, 1, kIndexNumber, 1, true, true, false},
    {"focal", "focal_sigma", "", &Sigmas::focal, 1, kFocalNumber, 1, true, true, true}};

}  // namespace

PortKind kind_of(const std::optional<refractive::Port<double>>& port) {
  if (!port) return PortKind::none;
  return std::holds_alternative<Flat>(*port) ? PortKind::flat : PortKind::dome;
}

std::optional<PortKind> common_kind(const Bundle& bundle) {
  if (bundle.cameras.empty()) return {};
  const PortKind first = kind_of(bundle.cameras.front().measured.port);
  if (std::ranges::any_of(bundle.cameras, [&](const BundleCamera& camera) {
        return kind_of(camera.measured.port) != first;
      }))
    return {};
  return first;
}

std::vector<HousingNumber> port_numbers(const refractive::Port<double>& port) {
  std::vector<HousingNumber> numbers;
  for (const NumberRow& row : kNumberRows) {
    if (row.kind != PortKind::none && row.kind != kind_of(port)) continue;
    const double value = value_of(port, row.number) * row.scale;
    numbers.push_back({static_cast<std::size_t>(row.number), row.quantity, row.name, row.title,
                       row.unit, row.scale, 0, value, 0, value, 0});
  }
  return numbers;
}

Sigmas ruler_sigmas() {
  return {.normal_degrees = 3,
          .distance = 0.005,
          .centre = 0.005,
          .thickness = 0.0005,
          .index = 0.004,
          .focal = 0.005};
}

std::span<const NumberGroup> number_groups() {
  return kGroups;
}

}  // namespace axial::pose
