// SPDX-License-Identifier: GPL-3.0-or-later
#include "cameras/private/port_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "base/error.h"

namespace axial::io {
namespace {

using Json = nlohmann::json;

void require_index(double n, const char* key, const std::string& where) {
  // No material of a port is denser than 3 (diamond: 2.4).
  if (!(n >= 1 && n <= 3)) fail("{}.{} is {}, expected an index from 1 to 3", where, key, n);
}

void require_length(double metres, const char* key, const std::string& where, double longest = 1) {
  if (!(metres >= 0 && metres <= longest))
    fail("{}.{} is {}, expected metres from 0 to {}", where, key, metres, longest);
}

void require_unit(const Eigen::Vector3d& normal, const std::string& where) {
  if (!(std::abs(normal.norm() - 1) < 1e-6))
    fail("{}.normal has length {}, expected 1", where, normal.norm());
}

Eigen::Vector3d unit_normal(const JsonPlace& place, const Context& context) {
  return io::unit_normal(place.vector(), place.where, context);
}

Json to_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

// Fields that both kinds of port have.

template <class Port>
void read_glass(const JsonPlace& place, Port& port) {
  port.thickness = place.number("thickness_m");
  port.n_air = place.has("n_air") ? place.number("n_air") : 1.0;
  port.n_glass = place.number("n_glass");
  port.n_water = place.number("n_water");
}

template <class Port>
void write_glass(const Port& port, Json& object) {
  object["thickness_m"] = port.thickness;
  object["n_air"] = port.n_air;
  object["n_glass"] = port.n_glass;
  object["n_water"] = port.n_water;
}

template <class Port>
void check_glass(const Port& port, const std::string& where) {
  require_length(port.thickness, "thickness_m", where);
  require_index(port.n_air, "n_air", where);
  require_index(port.n_glass, "n_glass", where);
  require_index(port.n_water, "n_water", where);
  if (port.n_glass < port.n_air || port.n_water < port.n_air)
    fail("{}.n_air is {}, more than n_glass {} or n_water {}", where, port.n_air, port.n_glass,
         port.n_water);
}

refractive::FlatPort<double> flat_from_json(const JsonPlace& place, const Context& context) {
  place.require_object(
      {"type", "distance_m", "thickness_m", "normal", "n_air", "n_glass", "n_water"});
  refractive::FlatPort<double> port;
  port.distance = place.number("distance_m");
  read_glass(place, port);
  if (place.has("normal")) port.normal = unit_normal(place.at("normal"), context);
  return port;
}

refractive::DomePort<double> dome_from_json(const JsonPlace& place) {
  place.require_object(
      {"type", "center_m", "inner_radius_m", "thickness_m", "n_air", "n_glass", "n_water"});
  refractive::DomePort<double> port;
  if (place.has("center_m")) port.centre = place.at("center_m").vector();
  port.inner_radius = place.number("inner_radius_m");
  read_glass(place, port);
  return port;
}

Json as_json(const refractive::FlatPort<double>& port) {
  Json object{{"type", "flat"}, {"distance_m", port.distance}, {"normal", to_json(port.normal)}};
  write_glass(port, object);
  return object;
}

Json as_json(const refractive::DomePort<double>& port) {
  Json object{
      {"type", "dome"}, {"center_m", to_json(port.centre)}, {"inner_radius_m", port.inner_radius}};
  write_glass(port, object);
  return object;
}

void check(const refractive::FlatPort<double>& port, const std::string& where, double longest_gap) {
  require_length(port.distance, "distance_m", where, longest_gap);
  check_glass(port, where);
  require_unit(port.normal, where);
  if (!(port.normal.z() > 0))
    fail("{}.normal points backwards: z is {}, but must be positive (from the camera to the water)",
         where, port.normal.z());
}

void check(const refractive::DomePort<double>& port, const std::string& where,
           double /*longest_gap*/) {
  require_length(port.inner_radius, "inner_radius_m", where);
  check_glass(port, where);
  // Farther out, the light of some pixels may graze the glass.
  const double away = port.centre.stableNorm();
  if (!(away < 0.9 * port.inner_radius))
    fail(
        "{}.center_m is {} m from the camera centre, expected less than 0.9 times inner_radius_m, "
        "which is {}",
        where, away, port.inner_radius);
}

}  // namespace

Eigen::Vector3d unit_normal(const Eigen::Vector3d& n, const std::string& where,
                            const Context& context) {
  const double length = n.stableNorm();
  if (!(length > 1e-6 && std::isfinite(length)))
    fail("{} is [{},{},{}], which is not a direction", where, n.x(), n.y(), n.z());
  if (std::abs(length - 1) > 1e-6) context.warning("{} has length {}: normalised", where, length);
  // A normal that is of unit length up to rounding stays unchanged, so that reading and writing a
  // file does not change it.
  return std::abs(length - 1) > 1e-15 ? Eigen::Vector3d(n / length) : n;
}

refractive::Port<double> port_from_json(const JsonPlace& place, double longest_gap,
                                        const Context& context) {
  if (!place.json.is_object()) fail("{} is not an object in braces", place.where);
  const std::string type = place.text("type");
  if (type != "flat" && type != "dome")
    fail("{}.type is '{}', expected 'flat', 'dome' or, in a housing, 'water-surface'", place.where,
         type);
  refractive::Port<double> port;
  if (type == "flat")
    port = flat_from_json(place, context);
  else
    port = dome_from_json(place);
  std::visit([&](const auto& kind) { check(kind, place.where, longest_gap); }, port);
  return port;
}

Json port_to_json(const refractive::Port<double>& port) {
  return std::visit([](const auto& kind) { return as_json(kind); }, port);
}

void check_port(const refractive::Port<double>& port, const std::string& where) {
  std::visit([&](const auto& kind) { check(kind, where, kLongestGap); }, port);
}

bool is_water_surface(const JsonPlace& place) {
  return place.has("type") && place.at("type").json == "water-surface";
}

WaterSurface water_surface_from_json(const JsonPlace& place, const Context& context) {
  place.require_object({"type", "normal", "point_m", "n_air", "n_water"});
  WaterSurface surface;
  surface.normal = unit_normal(place.at("normal"), context);
  surface.point = place.at("point_m").vector();
  if (place.has("n_air")) surface.n_air = place.number("n_air");
  surface.n_water = place.number("n_water");
  check_water_surface(surface, place.where);
  return surface;
}

Json water_surface_to_json(const WaterSurface& surface) {
  return {{"type", "water-surface"},
          {"normal", to_json(surface.normal)},
          {"point_m", to_json(surface.point)},
          {"n_air", surface.n_air},
          {"n_water", surface.n_water}};
}

void check_water_surface(const WaterSurface& surface, const std::string& where) {
  require_index(surface.n_air, "n_air", where);
  require_index(surface.n_water, "n_water", where);
  if (surface.n_water < surface.n_air)
    fail("{}.n_air is {}, more than n_water {}", where, surface.n_air, surface.n_water);
  require_unit(surface.normal, where);
  if (const Eigen::Vector3d& p = surface.point; !p.allFinite())
    fail("{}.point_m is [{},{},{}], which is not a point", where, p.x(), p.y(), p.z());
}

namespace {

// Reads a list into the first elements of `numbers`.
void read_list(const JsonPlace& place, const char* key, std::span<double> numbers) {
  if (!place.has(key)) return;
  const JsonPlace list = place.at(key);
  if (!list.json.is_array() || list.json.size() > numbers.size())
    list.refuse(fmt::format("at most {} numbers", numbers.size()));
  std::size_t i = 0;
  for (const JsonPlace& element : list.elements()) numbers[i++] = element.number();
}

double read_type(const JsonPlace& place) {
  const std::string type = place.text("type");
  if (type != "perspective" && type != "fisheye")
    fail("{}.type is '{}', expected 'perspective' or 'fisheye'", place.where, type);
  return type == "fisheye" ? 1 : 0;
}

}  // namespace

refractive::LensDistortion<double> distortion_from_json(const JsonPlace& place) {
  place.require_object({"type", "spread", "radial", "radial_below", "tangential", "thin_prism"});
  refractive::LensDistortion<double> lens;
  lens.fisheye = read_type(place);
  if (place.has("spread")) lens.spread = place.number("spread");
  read_list(place, "radial", lens.above);
  read_list(place, "radial_below", lens.below);
  double tangential[] = {0, 0};
  read_list(place, "tangential", tangential);
  lens.p1 = tangential[0];
  lens.p2 = tangential[1];
  read_list(place, "thin_prism", {lens.prism.data(), 2});
  if (!(lens.spread > 0))
    fail("{}.spread is {}, expected a positive number", place.where, lens.spread);
  if (!(lens.above[0] > 0))
    fail("{}.radial begins with {}, expected a positive number", place.where, lens.above[0]);
  return lens;
}

nlohmann::json distortion_to_json(const refractive::LensDistortion<double>& lens) {
  return {{"type", lens.fisheye > 0 ? "fisheye" : "perspective"},
          {"spread", lens.spread},
          {"radial", lens.above},
          {"radial_below", lens.below},
          {"tangential", {lens.p1, lens.p2}},
          {"thin_prism", {lens.prism.x(), lens.prism.y()}}};
}

}  // namespace axial::io
