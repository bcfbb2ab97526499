// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/completeness.h"

#include <fmt/format.h>

#include "base/error.h"
#include "experiments/steps.h"

namespace axial::experiments {
namespace {

namespace fs = std::filesystem;

bool is_near(const std::string& preset) {
  return preset.starts_with("closeup") || preset.starts_with("thicket");
}

bool is_strip(const std::string& preset) {
  return preset.starts_with("transect");
}

SceneOptions scene_of(const CompletenessOptions& options, int seed) {
  SceneOptions scene;
  scene.preset = options.preset;
  scene.seed = seed;
  scene.views = 0;  // 0: number of the preset
  scene.samples = 3;
  scene.truth = false;
  scene.medium = options.poses == "colmap" ? "both" : options.medium;
  scene.more = options.scene;
  return scene;
}

Words evaluation_words(const CompletenessOptions& options, const SimulatedScene& scene,
                       const fs::path& dense) {
  Words words{"-i", (dense / "scene_dense.ply").string(), "-m", scene.mesh().string()};
  words += {"--cameras", scene.model().string()};
  if (options.medium == "water") words += {"--housing", scene.housing().string()};
  words += {"--tolerance", fmt::format("{}", tolerance_of(options))};
  if (is_strip(options.preset)) words += {"--strip"};
  return words;
}

fs::path model_of(const Chain& chain, const CompletenessOptions& options,
                  const SimulatedScene& scene) {
  if (options.poses == "true") return scene.model();
  const ColmapPoses poses = colmap_poses(chain, "colmap", scene, "air", true_lens(scene));
  if (poses.model.empty()) fail_in(scene.images("air"), "COLMAP found no poses");
  return poses.model;
}

// The report of EvaluateReconstruction without histograms, and the CPU time of DensifyPointCloud.
Json measured(const Chain& chain, const CompletenessOptions& options, int seed) {
  const SimulatedScene scene = simulated(chain, scene_of(options, seed));
  DenseOptions dense_options;
  if (options.medium == "water") dense_options.housing = scene.housing();
  dense_options.more = options.dense;
  const fs::path dense = densified(chain, options.poses + "-" + options.medium, scene,
                                   model_of(chain, options, scene), options.medium, dense_options);
  const fs::path file = dense / "evaluation.json";
  Words words = evaluation_words(options, scene, dense);
  words += {"--json", file.string()};
  run_sibling(chain, "EvaluateReconstruction", words, dense / "evaluate.log");
  Json result = io::json_from(read_file(file));
  for (const char* unneeded :
       {"input", "truth", "align", "color_max", "accuracy_histogram", "completeness_histogram"})
    result.erase(unneeded);
  result["cpu_seconds"] = densify_seconds(dense);
  return result;
}

std::string part_name(int seed) {
  return fmt::format("seed{}", seed);
}

}  // namespace

std::string completeness_name(const CompletenessOptions& options) {
  return fmt::format("completeness_{}_{}_{}", options.preset, options.medium, options.poses);
}

double tolerance_of(const CompletenessOptions& options) {
  if (options.tolerance > 0) return options.tolerance;
  return is_near(options.preset) ? 0.002 : 0.005;
}

Experiment completeness(const Chain& chain, const CompletenessOptions& options) {
  Experiment experiment{completeness_name(options), {}};
  const Json programs = programs_of_the_chain();
  for (const int seed : options.seeds)
    experiment.parts.push_back({part_name(seed),
                                {{"version", 1},
                                 {"programs", programs},
                                 {"scene", to_json(scene_of(options, seed))},
                                 {"medium", options.medium},
                                 {"poses", options.poses},
                                 {"tolerance", tolerance_of(options)},
                                 {"dense", options.dense}},
                                [=] { return measured(chain, options, seed); }});
  return experiment;
}

}  // namespace axial::experiments
