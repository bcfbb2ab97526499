// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colmap/other_ports.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "colmap/private/colmap_parts.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

std::vector<double> numbers_of(const WaterSurface& s) {
  return {s.normal.x(), s.normal.y(), s.normal.z(), s.point.x(),
          s.point.y(),  s.point.z(),  s.n_air,      s.n_water};
}

template <class Port>
std::vector<double> numbers_of(const Port& port) {
  const PortNumbers numbers = port_numbers(port);
  return {numbers.begin(), numbers.end()};
}

// Null for "none" and for a name that is not defined, which readers refuse.
const HousingPort* port_named(const Housing& housing, const std::string& name) {
  const auto port = housing.ports.find(name);
  return port == housing.ports.end() ? nullptr : &port->second;
}

bool same(const HousingPort* a, const HousingPort* b) {
  return a && b ? same_port(*a, *b) : a == b;
}

// Finds the port by the end of a path, as attach_ports does.
const HousingPort* port_by_path(const Housing& housing, const std::string& path) {
  const auto entry = housing.entry_of(fs::path(path).generic_string());
  return port_named(housing, entry == housing.images.end() ? housing.default_port : entry->second);
}

}  // namespace

bool same_port(const HousingPort& a, const HousingPort& b) {
  const auto numbers = [](const auto& port) { return numbers_of(port); };
  return a.index() == b.index() &&
         std::ranges::equal(std::visit(numbers, a), std::visit(numbers, b),
                            [](double x, double y) { return std::abs(x - y) <= 1e-9; });
}

std::string image_with_other_port(const Housing& taken, const Housing& other,
                                  const ColmapModel& model) {
  for (const ColmapImage& image : model.images) {
    const HousingPort* const other_port =
        port_named(other, other.port_of(image.name, image.camera));
    if (other_port && !same(port_named(taken, taken.port_of(image.name, image.camera)), other_port))
      return image.name;
  }
  return {};
}

void warn_of_other_ports(const Housing& taken, const std::string& taken_from, const Housing& other,
                         const std::string& other_from, const ColmapModel& model,
                         const Context& context) {
  const std::string image = image_with_other_port(taken, other, model);
  if (!image.empty())
    context.warning(
        "The ports of {} are used; the ports of {} differ and are ignored, first for {}",
        taken_from, other_from, image);
}

bool gives_no_image_a_port(const Housing& housing, const ColmapModel& model) {
  return !housing.ports.empty() && std::ranges::all_of(model.images, [&](const ColmapImage& image) {
    return housing.port_of(image.name, image.camera) == "none";
  });
}

void warn_of_housing_beside(const Scene& scene, const fs::path& scene_path, const Housing& taken,
                            const fs::path& file, const Context& context) {
  const fs::path beside = housing_beside(scene_path);
  std::error_code error;
  if (!fs::exists(beside, error) || fs::equivalent(beside, file, error)) return;
  Housing other;
  try {
    other = read_housing(beside, PortValues::passed_over, context);
  } catch (const Error& unreadable) {
    return context.warning("{}: is not used ({} is used instead), and cannot be read: {}",
                           beside.string(), file.string(), unreadable.text());
  }
  for (const SceneImage& image : scene.images)
    if (!same(port_by_path(taken, image.path), port_by_path(other, image.path)))
      return context.warning(
          "{}: is not used ({} is used instead), and its ports differ, first for {}",
          beside.string(), file.string(), image.path);
}

}  // namespace axial::io
