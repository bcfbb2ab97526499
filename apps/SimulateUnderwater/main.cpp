// SPDX-License-Identifier: GPL-3.0-or-later
// Makes a synthetic scene with ground truth: images in air and behind a port under water.

#include "arguments.h"
#include "base/atomic_file.h"
#include "base/log.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "io/images/image.h"
#include "light.h"
#include "plates.h"
#include "simulate/second_camera.h"
#include "write_scene.h"

namespace axial::apps {
namespace {

// A second survey has other noise than the first one.
std::uint32_t noise_seed(const simulate::PresetOptions& preset) {
  return preset.changed ? ~preset.seed : preset.seed;
}

// Renders the images and truth of all views in one medium, as far as the options ask for them. With
// --water, photographs under water are not made here.
void photograph(const Arguments& a, const simulate::Preset& preset, const simulate::RayScene& scene,
                const simulate::Shader& shader, bool water, const std::filesystem::path& folder) {
  for (std::size_t i = 0; i < preset.views.size(); ++i)
    make_folder((folder / view_name(preset, i)).parent_path());
  const ProgressSink progress = console_progress(water ? "Images (water)" : "Images (air)");
  for (std::size_t i = 0; i < preset.views.size(); ++i) {
    const simulate::View& view = preset.views[i];
    const simulate::Port through = port_of_view(preset, view);
    const simulate::Port* port = water ? &through : nullptr;
    if (a.truth)
      write_truth(folder, view_name(preset, i),
                  simulate::render_truth(scene, preset.lens, port, view));
    if (!a.truth_only && !(water && !a.water.empty())) {
      cv::Mat3f radiance =
          simulate::render_radiance(scene, shader, preset.lens, port, view, a.samples);
      simulate::add_haze(radiance, a.haze);
      const auto key = simulate::noise_key(noise_seed(a.preset), i, water);
      io::write_jpeg(folder / (view_name(preset, i) + ".jpg"),
                     simulate::develop(radiance, a.noise, key), a.jpeg_quality);
    }
    progress(i + 1, preset.views.size());
  }
}

// Plates stay where they are: a second survey has the plates of the first.
PlatesOnGround plates_of(const Arguments& a, const simulate::Preset& preset,
                         const simulate::TriangleMesh& mesh) {
  if (!a.preset.changed) return plates_on(mesh, preset, a);
  simulate::PresetOptions first = a.preset;
  first.changed = false;
  simulate::Preset before = simulate::make_preset(first);
  apply_lens_option(before, a);
  return plates_on(simulate::terrain_mesh(before.terrain), before, a);
}

// `water`: empty unless --water is given.
void simulate_scene(const Arguments& a, const simulate::Preset& preset,
                    const std::optional<simulate::AnyWater>& water,
                    const std::filesystem::path& folder) {
  make_folder(folder);
  simulate::TriangleMesh mesh = simulate::terrain_mesh(preset.terrain);
  check_submerged(preset, mesh);
  if (water) check_depth(*water, preset, mesh);
  const auto first_plate_face = static_cast<std::uint32_t>(mesh.faces.size());
  const PlatesOnGround plates = plates_of(a, preset, mesh);
  append(mesh, simulate::plate_mesh(plates.plates));
  log_info("{}: {} vertices, {} faces", a.preset.name, mesh.vertices.size(), mesh.faces.size());
  const simulate::RayScene scene(mesh);
  const simulate::Shader shader =
      simulate::with_plates(simulate::seabed_shader(mesh, scene, preset.texture), plates.plates,
                            first_plate_face, a.samples);
  if (!plates.plates.empty()) write_true_targets(folder, plates, scene, preset, a.medium);
  write_mesh(folder / "mesh.ply", mesh);
  if (preset.moved) write_change(folder / "change.json", preset, simulate::true_change(preset));
  if (!a.truth_only) {
    write_port(folder / "housing.json", preset);
    write_sparse_model(folder / "sparse", preset,
                       simulate::true_points(scene, shader, preset.lens, preset.views,
                                             a.sparse_points, a.preset.seed));
  }
  if (a.medium != "water") photograph(a, preset, scene, shader, false, folder / "air");
  if (a.medium != "air") photograph(a, preset, scene, shader, true, folder / "water");
  if (water) {
    const simulate::Shader albedo = simulate::with_plates(
        simulate::albedo_shader(preset.texture), plates.plates, first_plate_face, a.samples);
    const std::vector<Eigen::Vector3f> normals = simulate::vertex_normals(mesh);
    photograph_with_light(a, preset, {scene, mesh, normals, albedo}, *water, noise_seed(a.preset),
                          folder / "water");
  }
}

int run(int argc, char** argv) {
  Arguments arguments;
  const ParsedOptions parsed = parse_options(argc, argv, describe(arguments));
  if (!parsed.run) return parsed.exit_code;
  check(arguments, parsed);
  const ThreadLimit limit(parsed.common.max_threads);
  simulate::Preset preset = simulate::make_preset(arguments.preset);
  if (!given(parsed, "haze")) arguments.haze = preset.haze;
  apply_lens_option(preset, arguments);
  apply_port_options(preset, arguments, parsed);
  simulate::check_ports(preset);
  if (given(parsed, "rig-base")) simulate::add_second_camera(preset, arguments.second_camera);
  std::optional<simulate::AnyWater> water;
  if (!arguments.water.empty()) water = water_of(arguments, parsed.common);
  simulate_scene(arguments, preset, water, arguments.output);
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("SimulateUnderwater", [&] { return axial::apps::run(argc, argv); });
}
