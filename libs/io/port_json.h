// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: a port in JSON (housing files, side files of depth maps).
#pragma once

#include <initializer_list>
#include <string>

#include "io/json.h"
#include "refractive/port.h"
#include "scene/water_surface.h"

namespace axial::io {

// A value inside a JSON file, with its place for error messages: `where` is "file: key.key".
struct JsonPlace {
  const nlohmann::json& json;
  std::string where;

  // Error unless this is an object whose keys are all among `known`.
  void require_object(std::initializer_list<const char*> known) const;
  bool has(const char* key) const;
  JsonPlace at(const std::string& key) const;  // Error if the key is missing
  double number(const char* key) const;        // Error unless a finite number
  std::string text(const char* key) const;
};

// A housing's flat port lies within this of the camera [m]: more is a mistaken unit.
inline constexpr double kLongestGap = 1;

// Reads a port object. Error for unknown keys, values no port has, a flat port further than
// `longest_gap` from the camera, and types other than "flat" and "dome". A normal off unit length
// by more than 1e-6 is normalised with a warning.
refractive::Port<double> port_from_json(const JsonPlace& place, double longest_gap = kLongestGap);
nlohmann::json port_to_json(const refractive::Port<double>& port);

// The same of type "water-surface".
bool is_water_surface(const JsonPlace& place);
WaterSurface water_surface_from_json(const JsonPlace& place);
nlohmann::json water_surface_to_json(const WaterSurface& surface);

// `n` with unit length, exactly as it is where it has that to rounding; with a warning where it is
// off by more than 1e-6. Error that starts with `where` if it is no direction.
Eigen::Vector3d unit_normal(const Eigen::Vector3d& n, const std::string& where);

// Error that starts with `where` for values no port has.
void check_port(const refractive::Port<double>& port, const std::string& where);
void check_water_surface(const WaterSurface& surface, const std::string& where);

}  // namespace axial::io
