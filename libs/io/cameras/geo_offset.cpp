// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cameras/geo_offset.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/error.h"
#include "base/program/output_name.h"
#include "io/bytes/json.h"
#include "io/bytes/json_place.h"

namespace axial::io {
namespace fs = std::filesystem;

namespace {

constexpr const char* kKey = "geo_offset";

// The spacing of floats at the largest coordinate of the scene's points.
double float_step(const Scene& scene) {
  float largest = 0;
  for (const SparsePoint& point : scene.points)
    largest = std::max(largest, point.position.cwiseAbs().maxCoeff());
  const float next = std::nextafter(largest, std::numeric_limits<float>::infinity());
  return static_cast<double>(next) - static_cast<double>(largest);
}

// A stale file of another scene shows in a large distance of the cameras from its offset.
void warn_if_far(const Scene& scene, const fs::path& file, const Context& context) {
  constexpr double kFar = 1e5;
  const double left = frame_of(scene).origin.norm();
  if (left > kFar)
    context.warning(
        "{}: the scene's cameras are {:.0f} m from this origin: check that the file belongs to the "
        "scene",
        file.string(), left);
}

}  // namespace

fs::path geo_offset_beside(const fs::path& scene_path) {
  return with_extension(scene_path, ".geo.json");
}

std::optional<LocalFrame> read_geo_offset_beside(const fs::path& scene_path) {
  const fs::path file = geo_offset_beside(scene_path);
  std::error_code error;
  if (!fs::exists(file, error)) return {};
  const nlohmann::json json = read_json(file);
  const JsonPlace root{json, file.string() + ": geo"};
  root.require_object({"version", kKey});
  root.require_version_1();
  return LocalFrame{root.at(kKey).vector()};
}

void write_geo_offset_beside(const fs::path& scene_path, const LocalFrame& frame,
                             const Context& context) {
  const fs::path file = geo_offset_beside(scene_path);
  if (frame.is_world()) {
    std::error_code error;
    if (fs::remove(file, error)) context.info("{} removed: the scene has no offset", file.string());
    return;
  }
  const Eigen::Vector3d& o = frame.origin;
  write_json(file, {{"version", 1}, {kKey, {o.x(), o.y(), o.z()}}});
}

LocalFrame enter_local_frame(Scene& scene, const fs::path& scene_path, const Context& context) {
  if (const auto frame = read_geo_offset_beside(scene_path)) {
    warn_if_far(scene, geo_offset_beside(scene_path), context);
    return *frame;
  }
  const LocalFrame frame = frame_of(scene);
  if (frame.is_world()) return frame;
  context.warning(
      "{}: is far from the origin: the output's coordinates are relative to ({}, {}, {}); the "
      "sparse points are float and have a resolution of only {:.2g} m (InterfaceCOLMAP keeps all "
      "digits)",
      scene_path.string(), frame.origin.x(), frame.origin.y(), frame.origin.z(), float_step(scene));
  enter(frame, scene);
  return frame;
}

Housing in_frame(const LocalFrame& frame, Housing housing) {
  if (frame.is_world()) return housing;
  for (auto& [name, port] : housing.ports)
    if (auto* surface = std::get_if<WaterSurface>(&port))
      surface->point = frame.to_local(surface->point);
  return housing;
}

namespace {

void move(const Similarity&, double length_factor, refractive::FlatPort<double>& port) {
  port.distance *= length_factor;
  port.thickness *= length_factor;
}

void move(const Similarity&, double length_factor, refractive::DomePort<double>& port) {
  port.centre *= length_factor;
  port.inner_radius *= length_factor;
  port.thickness *= length_factor;
}

void move(const Similarity& similarity, double, WaterSurface& surface) {
  surface.normal = (similarity.rotation * surface.normal).normalized();
  surface.point = similarity(surface.point);
}

}  // namespace

Housing moved(const Similarity& similarity, Housing housing, bool scale_ports) {
  const double length_factor = scale_ports ? similarity.scale : 1;
  for (auto& [name, port] : housing.ports)
    std::visit([&](auto& one) { move(similarity, length_factor, one); }, port);
  for (auto& [name, sigmas] : housing.sigmas) sigmas = scaled(sigmas, length_factor);
  return housing;
}

}  // namespace axial::io
