// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/port_json.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"

namespace axial::io {
namespace {

using nlohmann::json;

// Remembers the keys of every open object, because the parser itself keeps the last of two values.
class DuplicateKeys {
 public:
  bool operator()(int /*depth*/, json::parse_event_t event, const json& parsed) {
    if (event == json::parse_event_t::object_start) open_.emplace_back();
    if (event == json::parse_event_t::object_end) open_.pop_back();
    if (event == json::parse_event_t::key && !open_.back().insert(parsed).second)
      fail("key {} occurs twice", parsed.dump());
    return true;
  }

 private:
  std::vector<std::set<std::string>> open_;
};

void require_index(double n, const char* key, const std::string& where) {
  // No transparent solid or liquid a port is made of is denser than 3 (diamond: 2.4).
  if (!(n >= 1 && n <= 3)) fail("{}.{} is {}, expected an index from 1 to 3", where, key, n);
}

void require_length(double metres, const char* key, const std::string& where) {
  if (!(metres >= 0 && metres <= 1))
    fail("{}.{} is {}, expected metres from 0 to 1", where, key, metres);
}

Eigen::Vector3d unit_normal(const JsonPlace& place) {
  const JsonPlace normal = place.at("normal");
  if (!normal.json.is_array() || normal.json.size() != 3)
    fail("{} is {}, expected three numbers", normal.where, normal.json.dump());
  Eigen::Vector3d n;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!normal.json[i].is_number())
      fail("{} is {}, expected three numbers", normal.where, normal.json.dump());
    n[static_cast<Eigen::Index>(i)] = normal.json[i].get<double>();
  }
  const double length = n.stableNorm();
  if (!(length > 1e-6 && std::isfinite(length)))
    fail("{} is {}, which is no direction", normal.where, normal.json.dump());
  if (std::abs(length - 1) > 1e-6)
    spdlog::warn("{} has length {}: normalised", normal.where, length);
  // Left as it is where it is unit to rounding, so that writing what was read changes nothing.
  return std::abs(length - 1) > 1e-15 ? Eigen::Vector3d(n / length) : n;
}

}  // namespace

json read_json(const std::filesystem::path& path) {
  constexpr std::uintmax_t kLargest = 256u << 20;
  const std::string bytes = read_file(path, kLargest);
  try {
    return json::parse(bytes, DuplicateKeys());
  } catch (const std::exception& error) {
    fail("{}: malformed JSON: {}", path.string(), error.what());
  }
}

void write_json(const std::filesystem::path& path, const json& value) {
  // Names in another encoding than UTF-8 cannot be kept exactly in JSON: say so, do not mangle.
  try {
    write_atomically(path, value.dump(2) + "\n");
  } catch (const json::exception& error) {
    fail("{}: cannot be written: {}", path.string(), error.what());
  }
}

void JsonPlace::require_object(std::initializer_list<const char*> known) const {
  if (!json.is_object()) fail("{} is no object in braces", where);
  for (const auto& [key, value] : json.items())
    if (std::ranges::none_of(known, [&](const char* name) { return key == name; }))
      fail("{}: unknown key '{}'", where, key);
}

JsonPlace JsonPlace::at(const std::string& key) const {
  const auto found = json.find(key);
  if (found == json.end()) fail("{}: key '{}' is missing", where, key);
  return {*found, fmt::format("{}.{}", where, key)};
}

double JsonPlace::number(const char* key) const {
  const JsonPlace value = at(key);
  if (!value.json.is_number()) fail("{} is {}, expected a number", value.where, value.json.dump());
  return value.json.get<double>();
}

std::string JsonPlace::text(const char* key) const {
  const JsonPlace value = at(key);
  if (!value.json.is_string()) fail("{} is {}, expected a text", value.where, value.json.dump());
  return value.json.get<std::string>();
}

refractive::FlatPort<double> port_from_json(const JsonPlace& place) {
  if (!place.json.is_object()) fail("{} is no object in braces", place.where);
  const std::string type = place.text("type");
  if (type == "dome")
    fail("{}.type is 'dome': dome ports are not supported yet, only flat ones", place.where);
  if (type != "flat") fail("{}.type is '{}', expected 'flat'", place.where, type);
  place.require_object(
      {"type", "distance_m", "thickness_m", "normal", "n_air", "n_glass", "n_water"});
  refractive::FlatPort<double> port;
  port.distance = place.number("distance_m");
  port.thickness = place.number("thickness_m");
  port.n_air = place.has("n_air") ? place.number("n_air") : 1.0;
  port.n_glass = place.number("n_glass");
  port.n_water = place.number("n_water");
  if (place.has("normal")) port.normal = unit_normal(place);
  check_port(port, place.where);
  return port;
}

json port_to_json(const refractive::FlatPort<double>& port) {
  return {{"type", "flat"},
          {"distance_m", port.distance},
          {"thickness_m", port.thickness},
          {"normal", {port.normal.x(), port.normal.y(), port.normal.z()}},
          {"n_air", port.n_air},
          {"n_glass", port.n_glass},
          {"n_water", port.n_water}};
}

void check_port(const refractive::FlatPort<double>& port, const std::string& where) {
  require_length(port.distance, "distance_m", where);
  require_length(port.thickness, "thickness_m", where);
  require_index(port.n_air, "n_air", where);
  require_index(port.n_glass, "n_glass", where);
  require_index(port.n_water, "n_water", where);
  if (port.n_glass < port.n_air || port.n_water < port.n_air)
    fail("{}.n_air is {}, more than n_glass {} or n_water {}", where, port.n_air, port.n_glass,
         port.n_water);
  if (!(std::abs(port.normal.norm() - 1) < 1e-6))
    fail("{}.normal has length {}, expected 1", where, port.normal.norm());
  if (!(port.normal.z() > 0))
    fail("{}.normal points backwards: z is {}, it must be positive (from the camera to the water)",
         where, port.normal.z());
}

}  // namespace axial::io
