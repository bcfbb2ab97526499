// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/chain.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/hash.h"
#include "base/parse_number.h"
#include "evaluate/alignment.h"
#include "experiments/steps.h"
#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"

namespace axial::experiments {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDensifySeconds = "densify.cpu-seconds";

Words options_of(const SceneOptions& o) {
  Words words{"--preset", o.preset, "--seed", fmt::format("{}", o.seed), "--medium", o.medium};
  const auto add = [&](const char* name, auto value) {
    if (std::ranges::find(o.more, name) == o.more.end()) words += {name, fmt::format("{}", value)};
  };
  add("--views", o.views);
  add("--width", o.width);
  add("--height", o.height);
  add("--samples", o.samples);
  add("--fov-degrees", o.fov_degrees);
  add("--scale", o.scale);
  add("--relief", o.relief);
  add("--coarseness", o.coarseness);
  add("--truth", o.truth ? 1 : 0);
  words += o.port;
  words += o.more;
  return words;
}

Words densify_words(const fs::path& folder, const DenseOptions& options) {
  Words words{"-i", "scene.mvs", "-w", folder.string()};
  if (!options.housing.empty()) words += {"--refractive"};
  words += options.more;
  return words;
}

std::string joined(const std::vector<double>& values) {
  std::string text;
  for (const double value : values)
    text += fmt::format("{}{:.17g}", text.empty() ? "" : ",", value);
  return text;
}

}  // namespace

Json programs_of_the_chain() {
  return content_of_programs({"SimulateUnderwater", "InterfaceCOLMAP", "DensifyPointCloud",
                              "AlignModel", "EvaluateReconstruction"});
}

Json to_json(const SceneOptions& options) {
  return options_of(options);
}

SimulatedScene simulated(const Chain& chain, const SceneOptions& options) {
  const std::string key = Fingerprint().add(io::to_text(to_json(options))).hex().substr(0, 8);
  SimulatedScene scene{chain.work / fmt::format("{}-{}-{}", options.preset, options.seed, key)};
  step(scene.folder, {to_json(options), content_of_programs({"SimulateUnderwater"})}, [&] {
    Words arguments = options_of(options);
    arguments += {"-o", scene.folder.string()};
    run_sibling(chain, "SimulateUnderwater", arguments, scene.folder / "simulate.log");
    for (const char* medium : {"air", "water"})
      if (fs::is_directory(scene.images(medium)))
        for (const fs::path& file : files_ending_in(scene.images(medium), ".normal.tiff"))
          fs::remove(file);
  });
  return scene;
}

refractive::FlatPort<double> port_of(const SimulatedScene& scene) {
  const io::Housing housing = io::read_housing(scene.housing());
  return std::get<refractive::FlatPort<double>>(housing.ports.at(housing.default_port));
}

Calibration true_lens(const SimulatedScene& scene) {
  return calibration_of(scene.model());
}

Calibration self_calibration(const SimulatedScene& scene) {
  std::vector<double> parameters = io::read_colmap_model(scene.model()).cameras.at(0).params;
  for (const std::size_t focal : {0u, 1u}) parameters.at(focal) *= port_of(scene).n_water;
  parameters.insert(parameters.end(), {0, 0, 0, 0});
  return {"OPENCV", joined(parameters), true};
}

Calibration calibration_of(const fs::path& colmap_model) {
  const io::ColmapCamera camera = io::read_colmap_model(colmap_model).cameras.at(0);
  return {camera.model, joined(camera.params), false};
}

ColmapPoses colmap_poses(const Chain& chain, const std::string& name, const SimulatedScene& scene,
                         const std::string& medium, const Calibration& calibration) {
  const fs::path folder = scene.folder / name, model = folder / "model", metric = folder / "metric";
  Words arguments{"--images", scene.images(medium).string(), "-o", folder.string()};
  arguments += {"--camera-model", calibration.model};
  arguments += {"--camera-parameters", calibration.parameters};
  if (calibration.refine) arguments += {"--refine"};
  // "model" is the layout of the folder. Folders that earlier versions left have no model/.
  const Json inputs{medium, calibration.model, calibration.parameters, calibration.refine, "model"};
  step(folder, inputs, [&] {
    // If COLMAP finds no poses, this is a result and not an error.
    run_sibling(chain, "axial-colmap-model", arguments, folder / "colmap.log",
                {"COLMAP found no poses"});
  });
  if (!fs::is_directory(model) || io::read_colmap_model(model).images.size() < 3) return {};
  // A step of its own, so that changes of the project's programs do not run COLMAP again.
  step(metric, {content_of(model), content_of_programs({"AlignModel"})}, [&] {
    run_sibling(
        chain, "AlignModel",
        {"-i", model.string(), "--reference", scene.model().string(), "-o", metric.string()},
        folder / "align.log");
  });
  const io::ColmapModel found = io::read_colmap_model(metric);
  const auto truth = io::read_colmap_model(scene.model());
  return {metric, found.images.size(), evaluate::align_centres(found, truth).rms};
}

fs::path densified(const Chain& chain, const std::string& name, const SimulatedScene& scene,
                   const fs::path& model, const std::string& medium, const DenseOptions& options) {
  const fs::path folder = scene.folder / name;
  Words import{"-i",
               model.string(),
               "--image-folder",
               scene.images(medium).string(),
               "-o",
               (folder / "scene.mvs").string()};
  const Words densify = densify_words(folder, options);
  // The file names are not enough: the files may hold other poses or another port.
  Words contents{content_of(model)};
  if (!options.housing.empty()) {
    import += {"--housing", options.housing.string()};
    contents += {content_of(options.housing)};
  }
  const Words excuses =
      options.or_nothing ? Words{"no image has neighbours to be matched with"} : Words{};
  const Json programs = content_of_programs({"InterfaceCOLMAP", "DensifyPointCloud"});
  step(folder, {import, densify, contents, programs}, [&] {
    run_sibling(chain, "InterfaceCOLMAP", import, folder / "import.log");
    const double before = children_seconds();
    run_sibling(chain, "DensifyPointCloud", densify, folder / "densify.log", excuses);
    write_atomically(folder / kDensifySeconds, fmt::format("{:.2f}", children_seconds() - before));
  });
  return fs::is_regular_file(folder / "scene_dense.ply") ? folder : fs::path();
}

double densify_seconds(const fs::path& dense) {
  const fs::path file = dense / kDensifySeconds;
  const auto seconds = parse_finite<double>(read_file(file));
  if (!seconds) fail_in(file, "is not a number of seconds");
  return *seconds;
}

fs::path fused_again(const Chain& chain, const fs::path& dense, const std::string& name,
                     const DenseOptions& options, const Words& fusion) {
  fs::path folder = dense / name;
  Words densify = densify_words(dense, options);
  densify += fusion;
  densify += {"-o", (folder / "scene_dense.mvs").string()};
  step(folder, {densify, content_of_programs({"DensifyPointCloud"})},
       [&] { run_sibling(chain, "DensifyPointCloud", densify, folder / "densify.log"); });
  return folder;
}

}  // namespace axial::experiments
