// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/openmvs/scene_with_cameras.h"

#include <algorithm>

#include "base/error.h"
#include "base/program/unused_input.h"
#include "io/cameras/geo_offset.h"
#include "io/colmap/other_ports.h"
#include "io/openmvs/mvs.h"

namespace axial::io {
namespace fs = std::filesystem;

namespace {

struct PortCount {
  std::size_t images = 0, wet = 0, flat = 0;  // calibrated, behind a port, behind a flat port
};

PortCount count_ports(const Scene& scene) {
  PortCount count;
  for (const SceneImage& image : scene.images) {
    const auto& port = image.camera.port;
    count.images += image.calibrated ? 1 : 0;
    count.wet += port ? 1 : 0;
    count.flat += port && std::holds_alternative<refractive::FlatPort<double>>(*port) ? 1 : 0;
  }
  return count;
}

// Error if the ports of the scene are not the demanded ones. `file`: their source.
void check_ports(const PortCount& count, const SceneFiles& files, const fs::path& file) {
  const bool demanded = files.ports == PortChoice::required || files.ports == PortChoice::flat;
  if (count.wet == 0 && demanded) fail_in(file, "gives no image a port");
  if (count.flat < count.images && files.ports == PortChoice::flat)
    fail_in(file, "only {} of {} images have a flat port, but {}", count.flat, count.images,
            setting("camera is flat_port"));
}

// Warns if the housing file, which is not used, gives an image of the scene a port.
void warn_of_ignored_ports(const Scene& scene, const fs::path& file, const Context& context) {
  std::error_code error;
  if (!fs::exists(file, error)) return;
  Scene with_ports = {scene.images, {}, {}, {}, {}};
  attach_ports(with_ports, read_housing(file, PortValues::passed_over, context), file.string(),
               context);
  if (const std::size_t wet = count_ports(with_ports).wet; wet > 0)
    context.warning(
        "{}: the ports of {} images are ignored: a scene whose poses were found with ports does "
        "not fit pinholes",
        file.string(), wet);
}

std::optional<Housing> attach_housing(Scene& scene, const LocalFrame& frame,
                                      const SceneFiles& files, const Context& context) {
  const fs::path file = housing_file(files);
  if (files.ports == PortChoice::ignored) {
    warn_of_ignored_ports(scene, file, context);
    return {};
  }
  std::error_code error;
  if (!fs::exists(file, error)) {
    if (files.ports != PortChoice::automatic)
      fail_in(file, "housing file not found; {} needs a housing file (see {})",
              setting(files.ports == PortChoice::flat ? "camera is flat_port" : "refractive"),
              setting("housing"));
    if (!files.housing.empty()) fail_in(file, "housing file not found");
    return {};
  }
  const Housing housing = read_housing(file, PortValues::checked, context);
  warn_of_housing_beside(scene, files.scene, housing, file, context);
  attach_ports(scene, in_frame(frame, housing), file.string(), context);
  const PortCount count = count_ports(scene);
  check_ports(count, files, file);
  context.info("Housing {}: {} of {} images behind a port", file.filename().string(), count.wet,
               count.images);
  if (count.wet > 0) return housing;
  if (!files.housing.empty() && !housing.ports.empty())
    UnusedInput(files.allow_missing)
        .report(fmt::format("{} {}: gives no image a port", setting("housing"), file.string()),
                context);
  return {};
}

void attach_lenses(Scene& scene, const SceneFiles& files, const Context& context) {
  if (attach_lenses_beside(scene, files.scene, context))
    context.info("{}: {} images have distorted lenses; they are used without resampling",
                 lenses_beside(files.scene).filename().string(),
                 std::ranges::count_if(scene.images, [](const SceneImage& image) {
                   return image.camera.distortion.has_value();
                 }));
}

void warn_of_missing_lenses(const SceneFiles& files, const Context& context) {
  const fs::path file = lenses_beside(files.scene);
  std::error_code error;
  if (!fs::exists(file, error))
    context.warning("{}: file not found: the images count as undistorted", file.string());
}

}  // namespace

fs::path housing_file(const SceneFiles& files) {
  return files.housing.empty() ? housing_beside(files.scene) : files.housing;
}

SceneWithCameras read_scene_with_cameras(const SceneFiles& files, const Context& context) {
  SceneWithCameras result;
  Scene& scene = result.scene;
  scene = read_mvs(files.scene, files.working_folder, context);
  result.frame = enter_local_frame(scene, files.scene, context);
  attach_lenses(scene, files, context);
  result.housing = attach_housing(scene, result.frame, files, context);
  if (result.housing) warn_of_missing_lenses(files, context);
  context.info("Scene {}: {} images, {} points", files.scene.filename().string(),
               scene.images.size(), scene.points.size());
  return result;
}

void write_cameras_beside(const fs::path& output, const SceneWithCameras& scene,
                          const SceneLenses& lenses, const SceneFiles& files,
                          const Context& context) {
  if (!scene.frame.is_world() || output != files.scene)
    write_geo_offset_beside(output, scene.frame, context);
  write_lenses_beside(output, lenses, scene.housing.has_value());
  const fs::path file = housing_beside(output);
  std::error_code error;
  if (fs::equivalent(file, housing_file(files), error)) return;
  if (scene.housing) return write_housing(file, *scene.housing);
  if (fs::remove(file, error)) context.info("{} removed: the scene has no ports", file.string());
}

}  // namespace axial::io
