// SPDX-License-Identifier: GPL-3.0-or-later
// Housing files: the port that each camera looks through (docs/formats.md).
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "axial/base.h"
#include "io/cameras/port_sigmas.h"
#include "refractive/port.h"
#include "scene/scene.h"
#include "scene/water_surface.h"

namespace axial::io {

// The refractive interface through which an image is taken: a port, which moves with the camera, or
// the surface of the water, which is fixed in the world.
using HousingPort =
    std::variant<refractive::FlatPort<double>, refractive::DomePort<double>, WaterSurface>;

// Returns `port` as a HousingPort, with the same values.
HousingPort to_housing_port(const refractive::Port<double>& port);

// The ports of the images of a scene or a COLMAP model. The name of an image is its path relative
// to the image folder, with '/' between components. The keys of `images` are image names or their
// ends in whole components.
struct Housing {
  std::map<std::string, HousingPort> ports;      // by name; no port is named "none"
  std::string default_port = "none";             // a name in `ports`, or "none": no port
  std::map<std::uint32_t, std::string> cameras;  // COLMAP camera id -> port name or "none"
  std::map<std::string, std::string> images;     // end of an image name -> port name or "none"
  // Standard deviations by name of the port. A port without an entry has no stated ones.
  std::map<std::string, PortSigmas> sigmas = {};

  // Returns the entry of `images` for an image. `image_name` is the name of the image, or a path
  // that ends in this name. An entry matches if its key is the end of `image_name` in whole path
  // components. Returns the longest matching entry, or `images.end()` if no entry matches. This
  // function does not check whether the entry also matches other images. for_images and
  // attach_ports check this.
  std::map<std::string, std::string>::const_iterator entry_of(const std::string& image_name) const;

  // Returns the name of the port of an image: the entry of the image in `images` (entry_of), or if
  // there is none, the entry of the camera in `cameras`, or if there is none, `default_port`.
  const std::string& port_of(const std::string& image_name, std::uint32_t camera_id) const;

  // Returns the port `name` for an image that was taken at `pose`; nothing for "none". A water
  // surface, which must be in the frame of `pose`, becomes a flat port for this pose
  // (port_seen_from in scene/water_surface.h). Error that starts with `image`, the name of the
  // image, if the port is not defined, if the camera is not above the water surface, or if the
  // optical axis does not meet the water surface.
  std::optional<refractive::Port<double>> port_at(const std::string& name, const Pose& pose,
                                                  const std::string& image) const;

  // Returns the port `name`, which moves with the camera; nothing for "none". Error if the port is
  // not defined, or if it is a water surface, because a water surface is another port for every
  // pose.
  std::optional<refractive::Port<double>> carried_port(const std::string& name) const;
};

// A housing with one port, named "main", for all images.
Housing housing_with(const HousingPort& port);

// Error that starts with `where` if a value of `port` is not possible. The comment of
// read_housing() lists these values. In addition, a normal whose length differs from 1 by 1e-6 or
// more is an error here.
void check_port(const refractive::Port<double>& port, const std::string& where);
void check_port(const HousingPort& port, const std::string& where);

// Error that names `file` and the port if a port of `housing` is a water surface. This function is
// for programs that can handle only ports that move with the camera.
void refuse_water_surfaces(const Housing& housing, const std::filesystem::path& file);

// Whether read_housing() warns of values that are possible but unusual (`checked`) or not
// (`passed_over`). Unusual are a water index outside 1.30 to 1.40, a glass index outside 1.30 to
// 2.00, and a normal of a flat port more than 30 degrees from the optical axis.
enum class PortValues { checked, passed_over };

// Reads a housing file or Calibmar's calibration.yaml (calibmar.h). The port of a calibration.yaml
// becomes the port of all images. Lengths of ports are in metres. The normal of a flat port and the
// centre of a dome are in the camera frame. The normal and the point of a water surface are in the
// world frame, and the point has the unit of the poses.
//
// Error that names the file, the key and the value for an unknown or missing key, a wrong type, a
// version other than 1, an unknown port type, a port name that is not defined, an index outside 1
// to 3, a length outside 0 to 1 m, a zero normal, a flat port's normal whose z is not positive, a
// standard deviation that is not possible (sigmas_from_json) or that belongs to a water surface,
// a dome centre that is not nearer to the camera than 0.9 times the inner radius, a water or glass
// index below the air index, or a Calibmar file without the key "non_svp_model". A normal whose
// length differs from 1 by more than 1e-6 is normalised. Warnings go through `context`, also those
// of normalised normals.
Housing read_housing(const std::filesystem::path& path, PortValues values = PortValues::checked,
                     const Context& context = {});

// Writes a housing file and replaces an existing one. Error that names the file for values of a
// port that are not possible, a port name that is not defined, or a file that cannot be written.
void write_housing(const std::filesystem::path& path, const Housing& housing);

// Returns the path "<scene without extension>.housing.json".
std::filesystem::path housing_beside(const std::filesystem::path& scene_path);

// An image of a COLMAP model and its camera.
struct NamedCamera {
  std::string name;          // name of an image: its path relative to the image folder
  std::uint32_t camera = 0;  // COLMAP's id of the camera
};

// Returns a copy of `housing` in which port_of() finds the right port of each image in `images`.
// `images` must hold all images of the model. An entry of `housing` that is the whole name of an
// image belongs to this image only. Other images whose names end in this entry get separate entries
// in the result. Error that starts with `file` and the entry and names two images, if an entry is
// the end of several names and the whole name of none.
Housing for_images(const Housing& housing, std::span<const NamedCamera> images,
                   const std::string& file);

// Attaches ports to the calibrated images of `scene`. The entry of an image in `housing.images` is
// the longest entry that is the end of the image's path in whole path components. An entry that is
// the whole path of another image does not count. An image without an entry gets
// `housing.default_port`. A water surface becomes a flat port for the pose of each image.
//
// Errors as for port_at() and for_images(). In addition, an Error if an image has no entry and
// `housing.cameras` is not empty, because a scene does not contain COLMAP's camera ids.
// (InterfaceCOLMAP therefore writes entries by image.) Warns through `context` of entries that
// match no image, and of a port if more than half of the views of sparse points through it are not
// possible (the point is not beyond the port) or lead through more than 25 m of water. All messages
// start with `file`. Precondition: `housing` is in the frame of `scene` (in_frame in geo_offset.h).
void attach_ports(Scene& scene, const Housing& housing, const std::string& file,
                  const Context& context = {});

}  // namespace axial::io
