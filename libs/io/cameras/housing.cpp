// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/housing.h"

#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "base/program/output_name.h"
#include "bytes/private/text_reader.h"
#include "cameras/private/image_names.h"
#include "cameras/private/port_json.h"
#include "cameras/private/port_values.h"
#include "io/colmap/calibmar.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSigma = "sigma";

bool is_dome(const HousingPort& port) {
  return std::holds_alternative<refractive::DomePort<double>>(port);
}

// Reads the port `name`, and its standard deviations.
void read_port(const std::string& name, const JsonPlace& place, Housing& housing,
               const Context& context) {
  if (is_water_surface(place)) {
    housing.ports[name] = water_surface_from_json(place, context);
    return;
  }
  nlohmann::json numbers = place.json;
  if (place.json.is_object()) numbers.erase(kSigma);
  HousingPort& port = housing.ports[name];
  port = to_housing_port(port_from_json({numbers, place.where}, kLongestGap, context));
  if (!place.has(kSigma)) return;
  const PortSigmas sigmas = sigmas_from_json(place.at(kSigma), is_dome(port));
  if (!sigmas.empty()) housing.sigmas[name] = sigmas;
}

void read_ports(const JsonPlace& place, Housing& housing, const Context& context) {
  for (const std::string& name : place.keys()) {
    if (name == kNone || name.empty())
      fail_in(place.where, "'{}' cannot be the name of a port ('none' means no port)", name);
    read_port(name, place.at(name), housing, context);
  }
}

void read_cameras(const JsonPlace& place, Housing& housing) {
  for (const std::string& key : place.keys()) {
    const auto id = parse_number<std::uint32_t>(key);
    if (!id) fail_in(place.where, "key '{}' is not a COLMAP camera id", key);
    if (housing.cameras.contains(*id)) fail_in(place.where, "camera {} occurs twice", *id);
    housing.cameras[*id] = defined_name(place, key, housing.ports, "port");
  }
}

void attach(SceneImage& image, const std::string& name, const Housing& housing,
            const std::string& file) {
  image.camera.port.reset();
  image.port_name.clear();
  if (name == kNone || !image.calibrated) return;
  image.camera.port = housing.port_at(name, image.pose, file + ": " + image.path);
  image.port_name = name;
}

// Returns of_surface(port) for a water surface, of_port(port) for a port that moves with the
// camera.
template <class OfSurface, class OfPort>
auto by_kind(const HousingPort& port, OfSurface of_surface, OfPort of_port) {
  if (const auto* surface = std::get_if<WaterSurface>(&port)) return of_surface(*surface);
  if (const auto* flat = std::get_if<refractive::FlatPort<double>>(&port)) return of_port(*flat);
  return of_port(std::get<refractive::DomePort<double>>(port));
}

using Port = refractive::Port<double>;

Housing calibmar_housing(const fs::path& path, const Context& context) {
  const ColmapCamera camera = read_calibmar(path, context);
  if (!camera.port && says_no_port(path)) return {};
  if (!camera.port) fail_in(path, "key 'non_svp_model' is missing");
  return housing_with(to_housing_port(*camera.port));
}

// Returns the port `name`; null for "none". Error that starts with `where` if it is not defined.
const HousingPort* find_port(const Housing& housing, const std::string& name,
                             const std::string& where) {
  if (name == kNone) return nullptr;
  const auto port = housing.ports.find(name);
  if (port == housing.ports.end()) fail("{} '{}' is not defined", where, name);
  return &port->second;
}

}  // namespace

HousingPort to_housing_port(const refractive::Port<double>& port) {
  return std::visit([](const auto& kind) -> HousingPort { return kind; }, port);
}

Housing housing_with(const HousingPort& port) {
  return {{{"main", port}}, "main", {}, {}};
}

std::map<std::string, std::string>::const_iterator Housing::entry_of(
    const std::string& image_name) const {
  return io::entry_of(images, image_name);
}

const std::string& Housing::port_of(const std::string& image_name, std::uint32_t camera_id) const {
  if (const auto entry = entry_of(image_name); entry != images.end()) return entry->second;
  if (const auto camera = cameras.find(camera_id); camera != cameras.end()) return camera->second;
  return default_port;
}

std::optional<refractive::Port<double>> Housing::port_at(const std::string& name, const Pose& pose,
                                                         const std::string& image) const {
  const std::string where = image + ": its port";
  const HousingPort* const port = find_port(*this, name, where);
  if (!port) return std::nullopt;
  return by_kind(
      *port,
      [&](const WaterSurface& surface) -> Port {
        return port_seen_from(pose, surface, fmt::format("{} '{}'", where, name));
      },
      [](const Port& fixed) { return fixed; });
}

std::optional<refractive::Port<double>> Housing::carried_port(const std::string& name) const {
  const HousingPort* const port = find_port(*this, name, "port");
  if (!port) return std::nullopt;
  return by_kind(
      *port,
      [&](const WaterSurface&) -> Port {
        fail("port '{}' is a water surface, which is a different port for every pose", name);
      },
      [](const Port& fixed) { return fixed; });
}

void check_port(const HousingPort& port, const std::string& where) {
  by_kind(
      port, [&](const WaterSurface& surface) { check_water_surface(surface, where); },
      [&](const Port& fixed) { check_port(fixed, where); });
}

void refuse_water_surfaces(const Housing& housing, const fs::path& file) {
  for (const auto& [name, port] : housing.ports)
    if (std::holds_alternative<WaterSurface>(port))
      fail_in(file,
              "housing.ports.{} is a water surface, expected ports that are fixed to the camera",
              name);
}

namespace {

Housing parse_housing(const fs::path& path, const Context& context) {
  if (is_calibmar(path)) return calibmar_housing(path, context);
  const nlohmann::json json = read_json(path);
  const JsonPlace root{json, path.string() + ": housing"};
  root.require_object({"version", "ports", "default", "cameras", "images"});
  root.require_version_1();
  Housing housing;
  read_ports(root.at("ports"), housing, context);
  housing.default_port = defined_name(root, "default", housing.ports, "port");
  if (root.has("cameras")) read_cameras(root.at("cameras"), housing);
  if (root.has("images")) housing.images = names_by_image(root.at("images"), housing.ports, "port");
  return housing;
}

}  // namespace

Housing read_housing(const fs::path& path, PortValues values, const Context& context) {
  Housing housing = parse_housing(path, context);
  if (values == PortValues::checked)
    for (const auto& [name, port] : housing.ports)
      warn_of_port_values(port, fmt::format("{}: housing.ports.{}", path.string(), name), context);
  return housing;
}

void write_housing(const fs::path& path, const Housing& housing) {
  const std::string where = path.string() + ": housing";
  nlohmann::json json{{"version", 1}, {"default", housing.default_port}};
  json["ports"] = nlohmann::json::object();
  for (const auto& [name, port] : housing.ports) {
    check_port(port, fmt::format("{}.ports.{}", where, name));
    json["ports"][name] = by_kind(port, water_surface_to_json, port_to_json);
    const auto sigmas = housing.sigmas.find(name);
    if (sigmas != housing.sigmas.end() && !sigmas->second.empty())
      json["ports"][name][kSigma] = sigmas_to_json(sigmas->second);
  }
  const auto checked = [&](const std::string& name) {
    if (name != kNone && !housing.ports.contains(name))
      fail_in(where, "port '{}' is not defined", name);
    return name;
  };
  checked(housing.default_port);
  for (const auto& [id, name] : housing.cameras)
    json["cameras"][std::to_string(id)] = checked(name);
  for (const auto& [image, name] : housing.images) json["images"][image] = checked(name);
  write_json(path, json);
}

fs::path housing_beside(const fs::path& scene_path) {
  return with_extension(scene_path, ".housing.json");
}

Housing for_images(const Housing& housing, std::span<const NamedCamera> images,
                   const std::string& file) {
  std::vector<std::string> names;
  for (const NamedCamera& image : images) names.push_back(image.name);
  const auto entries = entries_of_all(housing.images, names, file + ": housing.images.");
  Housing result = housing;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (entries[i] == housing.entry_of(names[i])) continue;
    // The longest matching end of this name is the whole name of another image.
    const auto camera = housing.cameras.find(images[i].camera);
    result.images[names[i]] = entries[i] != housing.images.end() ? entries[i]->second
                              : camera != housing.cameras.end()  ? camera->second
                                                                 : housing.default_port;
  }
  return result;
}

void attach_ports(Scene& scene, const Housing& housing, const std::string& file,
                  const Context& context) {
  const UseEntry use = [&](SceneImage& image, auto entry) {
    const bool has_entry = entry != housing.images.end();
    if (!has_entry && !housing.cameras.empty())
      fail_in(file,
              "housing.cameras names ports by COLMAP camera, which a scene does not contain: add "
              "an entry for {} under housing.images (InterfaceCOLMAP writes these entries)",
              image.path);
    attach(image, has_entry ? entry->second : housing.default_port, housing, file);
  };
  for_each_entry(scene, housing.images, file, "housing.images", use, context);
  warn_of_ports_in_scene(scene, housing, file, context);
}

}  // namespace axial::io
