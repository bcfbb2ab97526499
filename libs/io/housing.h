// SPDX-License-Identifier: GPL-3.0-or-later
// Housing files: which port each camera looks through (DESIGN section 5).
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "refractive/port.h"
#include "scene/scene.h"
#include "scene/water_surface.h"

namespace axial::io {

// What images look through: a port, which goes with its camera, or the surface of the water, which
// stays where it is in the world.
using HousingPort =
    std::variant<refractive::FlatPort<double>, refractive::DomePort<double>, WaterSurface>;

HousingPort to_housing_port(const refractive::Port<double>& port);

struct Housing {
  std::map<std::string, HousingPort> ports;
  std::string default_port = "none";             // "none": dry
  std::map<std::uint32_t, std::string> cameras;  // COLMAP camera id -> port name
  std::map<std::string, std::string> images;     // image name -> port name

  // The entry of `images` for an image, by its name or any path that ends in it: the longest one
  // that matches the end in whole components. `images.end()` if there is none. Only for_images and
  // attach_ports tell whether another image goes by it, too.
  std::map<std::string, std::string>::const_iterator entry_of(const std::string& image_name) const;

  // The port name for an image: its own entry, else its camera's, else the default.
  const std::string& port_of(const std::string& image_name, std::uint32_t camera_id) const;

  // The port `name` of the image `image` taken at `pose`; nothing for "none". Error that starts
  // with the image's name for a port that is not defined, and for a water surface that the camera
  // is not above or looks away from (port_seen_from).
  std::optional<refractive::Port<double>> port_at(const std::string& name, const Pose& pose,
                                                  const std::string& image) const;

  // The port `name` where poses do not count; nothing for "none". Error for a port that is not
  // defined, and for a water surface.
  std::optional<refractive::Port<double>> carried_port(const std::string& name) const;
};

// One port, "main", for every image.
Housing housing_with(const HousingPort& port);

// Error that starts with `where` for values no port has.
void check_port(const refractive::Port<double>& port, const std::string& where);
void check_port(const HousingPort& port, const std::string& where);

// Error that names `file` and the port if one is a water surface: for programs that work on what
// goes with a camera.
void refuse_water_surfaces(const Housing& housing, const std::filesystem::path& file);

// Error that names file, key and value: unknown keys, wrong types or units (an index below 1,
// negative thickness, zero or backward normal, distance over 1 m, a dome centre outside the dome,
// water less dense than air), a port name that is not defined, a version other than 1, an unknown
// port type. A normal off unit length by more than 1e-6 is normalised with a warning. Of Calibmar's
// calibration.yaml (calibmar.h) the port, for every image; Error if it has none.
// Values that no port has under water are warnings (warn_of_port_values), unless `values` passes
// over them.
enum class PortValues { checked, passed_over };
Housing read_housing(const std::filesystem::path& path, PortValues values = PortValues::checked);

void write_housing(const std::filesystem::path& path, const Housing& housing);

// "<scene without extension>.housing.json".
std::filesystem::path housing_beside(const std::filesystem::path& scene_path);

struct NamedCamera {
  std::string name;          // of an image, relative to the image folder
  std::uint32_t camera = 0;  // COLMAP's id
};

// `housing` for these images and no others. An entry that is an image's whole name is that image's
// alone: others that end in it get an entry of their own. Error that names `file`, the entry and
// two images, if an entry is the end of several images' names and the whole name of none.
Housing for_images(const Housing& housing, std::span<const NamedCamera> images,
                   const std::string& file);

// Attaches ports to the scene's calibrated images by their paths, and a water surface as each
// image's pose has it. `cameras` must be resolved already (InterfaceCOLMAP writes entries by image
// where cameras differ). Every line starts with `file`: errors that name the image, as port_at and
// for_images; warnings for entries that no image goes by, and for ports that the scene's sparse
// points do not go with (warn_of_ports_in_scene).
void attach_ports(Scene& scene, const Housing& housing, const std::string& file);

}  // namespace axial::io
