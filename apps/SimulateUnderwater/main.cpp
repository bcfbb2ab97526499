// SPDX-License-Identifier: GPL-3.0-or-later
// Makes a synthetic scene with ground truth: images in air and behind a flat port under water.
#include <spdlog/spdlog.h>

#include "base/error.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "base/program.h"
#include "base/progress.h"
#include "io/image.h"
#include "simulate/presets.h"
#include "write_scene.h"

namespace po = boost::program_options;
using namespace axial;

namespace {

struct Arguments {
  simulate::PresetOptions preset;
  std::string output, medium;
  int samples = 0, jpeg_quality = 0;
  double noise = 0;
  bool truth_only = false;
  double port_distance = 0, port_thickness = 0, tilt_degrees = 0, n_glass = 1, n_water = 1;
};

ProgramOptions describe(Arguments& a) {
  ProgramOptions program;
  program.name = "SimulateUnderwater";
  program.description = "makes a synthetic scene with ground truth, in air and under water";
  const simulate::PresetOptions preset;
  program.visible.add_options()("preset", po::value(&a.preset.name)->default_value(preset.name),
                                "reef or closeup")(
      "seed", po::value(&a.preset.seed)->default_value(preset.seed), "of everything random")(
      "output,o", po::value(&a.output), "folder of the scene (required)")(
      "views", po::value(&a.preset.views)->default_value(0), "images (0: the preset's number)")(
      "width", po::value(&a.preset.width)->default_value(preset.width), "of the images [px]")(
      "height", po::value(&a.preset.height)->default_value(preset.height), "of the images [px]")(
      "fov-degrees",
      po::value(&a.preset.horizontal_fov_degrees)->default_value(preset.horizontal_fov_degrees),
      "horizontal field of view in air")("samples", po::value(&a.samples)->default_value(3),
                                         "rays along each side of a pixel")(
      "port-distance", po::value(&a.port_distance), "camera centre to glass [m]")(
      "port-thickness", po::value(&a.port_thickness), "of the glass [m]")(
      "tilt-degrees", po::value(&a.tilt_degrees), "of the port against the optical axis")(
      "n-glass", po::value(&a.n_glass), "refractive index")("n-water", po::value(&a.n_water),
                                                            "refractive index")(
      "noise", po::value(&a.noise)->default_value(1.2), "standard deviation [grey levels]")(
      "jpeg-quality", po::value(&a.jpeg_quality)->default_value(93), "1 to 100")(
      "truth-only", po::value(&a.truth_only)->default_value(false)->implicit_value(true),
      "write mesh.ply, distances and normals, nothing else")(
      "medium", po::value(&a.medium)->default_value("both"), "air, water or both");
  return program;
}

void check(const Arguments& a) {
  if (a.output.empty()) fail("no output folder given (-o DIR)");
  if (a.medium != "air" && a.medium != "water" && a.medium != "both")
    fail("--medium is '{}': must be air, water or both", a.medium);
  if (!(a.noise >= 0 && a.noise <= 255)) fail("--noise is {}: must be between 0 and 255", a.noise);
  if (a.jpeg_quality < 1 || a.jpeg_quality > 100)
    fail("--jpeg-quality is {}: must be between 1 and 100", a.jpeg_quality);
  if (a.samples < 1 || a.samples > 16) fail("--samples is {}: must be between 1 and 16", a.samples);
  if (!(std::abs(a.tilt_degrees) <= 45))
    fail("--tilt-degrees is {}: must be between -45 and 45", a.tilt_degrees);
}

void apply_port_options(simulate::Port& port, const Arguments& a, const po::variables_map& values) {
  if (given(values, "port-distance")) port.distance = a.port_distance;
  if (given(values, "port-thickness")) port.thickness = a.port_thickness;
  if (given(values, "tilt-degrees")) port.normal = simulate::tilted_normal(a.tilt_degrees);
  if (given(values, "n-glass")) port.n_glass = a.n_glass;
  if (given(values, "n-water")) port.n_water = a.n_water;
}

int simulate_scene(const Arguments& a, const simulate::Preset& preset,
                   const std::filesystem::path& folder) {
  const simulate::TriangleMesh mesh = simulate::terrain_mesh(preset.terrain);
  spdlog::info("{}: {} vertices, {} faces", a.preset.name, mesh.vertices.size(), mesh.faces.size());
  const simulate::RayScene scene(mesh);
  const simulate::Shader shader = simulate::seabed_shader(mesh, scene, preset.texture);
  make_folder(folder);
  if (a.truth_only) {
    write_mesh(folder / "mesh.ply", mesh);
  } else {
    write_port(folder / "housing.json", preset.port);
    write_sparse_model(
        folder / "sparse", preset.lens, preset.views,
        simulate::true_points(scene, shader, preset.lens, preset.views, 400, a.preset.seed));
    write_mesh(folder / "mesh.ply", mesh);
  }
  for (const bool water : {false, true}) {
    const std::string medium = water ? "water" : "air";
    if (a.medium != "both" && a.medium != medium) continue;
    make_folder(folder / medium);
    const simulate::Port* port = water ? &preset.port : nullptr;
    const ProgressSink progress = console_progress("Images (" + medium + ")");
    for (std::size_t i = 0; i < preset.views.size(); ++i) {
      const simulate::View& view = preset.views[i];
      write_truth(folder / medium, view_name(i),
                  simulate::render_truth(scene, preset.lens, port, view));
      if (!a.truth_only) {
        const auto radiance =
            simulate::render_radiance(scene, shader, preset.lens, port, view, a.samples);
        const auto key = simulate::noise_key(a.preset.seed, i, water);
        io::write_jpeg(folder / medium / (view_name(i) + ".jpg"),
                       simulate::develop(radiance, a.noise, key), a.jpeg_quality);
      }
      progress(i + 1, preset.views.size());
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return run_program("SimulateUnderwater", [&] {
    Arguments arguments;
    const ParsedOptions parsed = parse_options(argc, argv, describe(arguments));
    if (!parsed.run) return parsed.exit_code;
    check(arguments);
    const ThreadLimit limit(parsed.common.max_threads);
    simulate::Preset preset = simulate::make_preset(arguments.preset);
    apply_port_options(preset.port, arguments, parsed.values);
    simulate::check_port(preset.port, preset.lens);
    return simulate_scene(arguments, preset, in_working_folder(parsed.common, arguments.output));
  });
}
