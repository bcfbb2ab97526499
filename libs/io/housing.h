// SPDX-License-Identifier: GPL-3.0-or-later
// Housing files: which port each camera looks through (DESIGN section 5).
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "refractive/port.h"
#include "scene/scene.h"

namespace axial::io {

struct Housing {
  std::map<std::string, refractive::Port<double>> ports;
  std::string default_port = "none";             // "none": dry
  std::map<std::uint32_t, std::string> cameras;  // COLMAP camera id -> port name
  std::map<std::string, std::string> images;     // image name -> port name

  // The entry of `images` for an image, by its name or any path that ends in it: the longest one
  // that matches the end in whole components. `images.end()` if there is none.
  std::map<std::string, std::string>::const_iterator entry_of(const std::string& image_name) const;

  // The port name for an image: its own entry, else its camera's, else the default.
  const std::string& port_of(const std::string& image_name, std::uint32_t camera_id) const;
};

// Error that starts with `where` for values no port has.
void check_port(const refractive::Port<double>& port, const std::string& where);

// Error that names file, key and value: unknown keys, wrong types or units (an index below 1,
// negative thickness, zero or backward normal, distance over 1 m, a dome centre outside the dome),
// a port name that is not defined, a version other than 1, an unknown port type. A normal off unit
// length by more than 1e-6 is normalised with a warning.
Housing read_housing(const std::filesystem::path& path);

void write_housing(const std::filesystem::path& path, const Housing& housing);

// "<scene without extension>.housing.json".
std::filesystem::path housing_beside(const std::filesystem::path& scene_path);

// Attaches ports to the scene's images by their paths. `cameras` must be resolved already
// (InterfaceCOLMAP writes entries by image where cameras differ).
void attach_ports(Scene& scene, const Housing& housing);

}  // namespace axial::io
