// SPDX-License-Identifier: GPL-3.0-or-later
// Housing files: the port that each camera looks through (docs/formats.md).
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

// The refractive interface through which an image is taken: a port, which moves with the camera, or
// the surface of the water, which is fixed in the world.
using HousingPort =
    std::variant<refractive::FlatPort<double>, refractive::DomePort<double>, WaterSurface>;

HousingPort to_housing_port(const refractive::Port<double>& port);

struct Housing {
  std::map<std::string, HousingPort> ports;
  std::string default_port = "none";             // "none": no port
  std::map<std::uint32_t, std::string> cameras;  // COLMAP camera id -> port name
  std::map<std::string, std::string> images;     // image name -> port name

  // Returns the entry of `images` for an image. `image_name` is its name or a path that ends in it.
  // An entry matches if it is the end of `image_name` in whole path components; the longest such
  // entry is taken. `images.end()` if there is none. This function does not check whether the same
  // entry matches other images; for_images and attach_ports do.
  std::map<std::string, std::string>::const_iterator entry_of(const std::string& image_name) const;

  // The name of the port of an image: its own entry, otherwise the entry of its camera, otherwise
  // the default.
  const std::string& port_of(const std::string& image_name, std::uint32_t camera_id) const;

  // Returns the port `name` for the image `image` taken at `pose`; nothing for "none". A water
  // surface becomes a flat port for this pose. Error that starts with `image` if the port is not
  // defined, if the camera is not above the water surface, or if its optical axis does not meet the
  // surface (port_seen_from).
  std::optional<refractive::Port<double>> port_at(const std::string& name, const Pose& pose,
                                                  const std::string& image) const;

  // Returns the port `name` where no pose is known; nothing for "none". Error if the port is not
  // defined or is a water surface.
  std::optional<refractive::Port<double>> carried_port(const std::string& name) const;
};

// A housing with one port, named "main", for all images.
Housing housing_with(const HousingPort& port);

// Error that starts with `where` for values that are not possible: see read_housing.
void check_port(const refractive::Port<double>& port, const std::string& where);
void check_port(const HousingPort& port, const std::string& where);

// Error that names `file` and the port if a port is a water surface. For programs that handle only
// ports that move with the camera.
void refuse_water_surfaces(const Housing& housing, const std::filesystem::path& file);

// `checked`: unusual values give warnings (warn_of_port_values).
enum class PortValues { checked, passed_over };
// Reads a housing file, or the port of Calibmar's calibration.yaml (calibmar.h), which then holds
// for all images. Lengths are metres. Directions and the dome centre are in the camera frame, a
// water surface is in the world.
//
// Error that names the file, the key and the value for an unknown key, a wrong type, a version
// other than 1, an unknown port type, a port name that is not defined, an index outside 1 to 3, a
// length outside 0 to 1 m, a zero or backward normal, a dome centre farther from the camera than
// 0.9 times the inner radius, a water or glass index below that of air, or a Calibmar file that
// does not mention a port. A normal whose length differs from 1 by more than 1e-6 is normalised
// with a warning.
Housing read_housing(const std::filesystem::path& path, PortValues values = PortValues::checked);

// Writes a housing file. Error that names the file and the port for values that are not possible or
// a port name that is not defined.
void write_housing(const std::filesystem::path& path, const Housing& housing);

// "<scene without extension>.housing.json".
std::filesystem::path housing_beside(const std::filesystem::path& scene_path);

struct NamedCamera {
  std::string name;          // of an image, relative to the image folder
  std::uint32_t camera = 0;  // COLMAP's id
};

// Returns `housing` resolved for these images. An entry that is the whole name of an image belongs
// to that image only; other images whose names end in it get an entry of their own. Error that
// names `file`, the entry and two images if an entry is the end of several names and the whole name
// of none.
Housing for_images(const Housing& housing, std::span<const NamedCamera> images,
                   const std::string& file);

// Attaches ports to the calibrated images of the scene, found by the ends of the image paths. A
// water surface becomes a flat port for each image's pose.
//
// Errors name the image, as in port_at and for_images. An image without an entry is also an Error
// if `housing.cameras` is not empty, because a scene does not know COLMAP's camera ids
// (InterfaceCOLMAP writes entries by image where cameras differ). Warns of entries that match no
// image, and of ports that disagree with the sparse points (warn_of_ports_in_scene). All messages
// start with `file`.
void attach_ports(Scene& scene, const Housing& housing, const std::string& file);

}  // namespace axial::io
