// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/fingerprint.h"

#include <initializer_list>
#include <vector>

#include "base/atomic_file.h"
#include "base/hash.h"
#include "base/parallel.h"

namespace axial::densify {
namespace {

void add_numbers(Fingerprint& print, std::initializer_list<double> values) {
  for (const double value : values) print.add(value);
}

void add_port(Fingerprint& print, const refractive::FlatPort<double>& port) {
  add_numbers(print, {port.normal.x(), port.normal.y(), port.normal.z(), port.distance,
                      port.thickness, port.n_air, port.n_glass, port.n_water});
}

void add_port(Fingerprint& print, const refractive::DomePort<double>& port) {
  print.add("dome");
  add_numbers(print, {port.centre.x(), port.centre.y(), port.centre.z(), port.inner_radius,
                      port.thickness, port.n_air, port.n_glass, port.n_water});
}

void add_distortion(Fingerprint& print, refractive::LensDistortion<double> distortion) {
  print.add("distortion");
  distortion.each_field([&](double number) { print.add(number); });
}

void add_camera(Fingerprint& print, const CameraModel& camera) {
  print.add(static_cast<std::uint64_t>(camera.width))
      .add(static_cast<std::uint64_t>(camera.height));
  print.add(camera.lens.fx).add(camera.lens.fy).add(camera.lens.cx).add(camera.lens.cy);
  if (camera.distortion) add_distortion(print, *camera.distortion);
  print.add(std::uint64_t{camera.port.has_value()});
  if (!camera.port) return;
  std::visit([&](const auto& port) { add_port(print, port); }, *camera.port);
}

void add_settings(Fingerprint& print, const Settings& settings) {
  const depth::PatchMatchOptions& matching = settings.matching;
  for (const std::uint64_t value :
       {static_cast<std::uint64_t>(matching.warp), static_cast<std::uint64_t>(settings.projection),
        static_cast<std::uint64_t>(matching.sub_resolution_levels),
        static_cast<std::uint64_t>(matching.iterations),
        static_cast<std::uint64_t>(settings.geometric_iterations),
        static_cast<std::uint64_t>(settings.postprocess),
        static_cast<std::uint64_t>(settings.ignore_mask_label)})
    print.add(value);
}

// Fingerprints of the files that each view's pixels and mask come from.
std::vector<std::string> content_of_files(const Project& project) {
  std::vector<std::string> prints(project.views.size());
  parallel_for(prints.size(), [&](std::size_t i) {
    if (!project.scene.images[i].calibrated) return;
    Fingerprint print;
    print.add(read_file(project.scene.images[i].path));
    if (!project.views[i].mask.empty()) print.add(read_file(project.views[i].mask));
    prints[i] = print.hex();
  });
  return prints;
}

}  // namespace

std::string fingerprint(const Project& project, const Settings& settings) {
  Fingerprint print;
  print.add("AxialMVS depth maps 12");  // the number is the version of the matching method
  add_settings(print, settings);
  if (!settings.map_settings.empty()) print.add(settings.map_settings);
  const std::vector<std::string> contents = content_of_files(project);
  for (std::size_t i = 0; i < project.views.size(); ++i) {
    const View& view = project.views[i];
    print.add(std::uint64_t{view.id});
    add_camera(print, view.camera);
    for (const double value : view.pose.rotation.reshaped()) print.add(value);
    for (const double value : view.pose.centre) print.add(value);
    print.add(contents[i]);
    if (view.file.bits > 8) print.add(static_cast<std::uint64_t>(project.bit_depth));
    if (view.file.alpha) print.add("transparent pixels are masked");
    for (const auto* list : {&project.neighbours[i], &project.sources[i]}) {
      print.add(static_cast<std::uint64_t>(list->size()));
      for (const ViewScore& neighbour : *list) print.add(std::uint64_t{neighbour.image});
    }
    for (const std::uint32_t point : project.preparations[i].init_points)
      for (const float value : project.scene.points[point].position)
        print.add(static_cast<double>(value));
  }
  return print.hex();
}

}  // namespace axial::densify
