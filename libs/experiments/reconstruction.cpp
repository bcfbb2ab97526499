// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's figures 5 and 6: a scene reconstructed in air and through a port, with the paper's
// method, with our method, and with one half (projection or warp) of each.
#include <fmt/format.h>

#include <array>

#include "base/error.h"
#include "experiments/chained.h"
#include "experiments/judge.h"
#include "experiments/steps.h"

namespace axial::experiments {

namespace {

// A way from photographs to a dense cloud.
struct Method {
  const char* name;  // name of the method's field in the results
  bool in_water;     // true: photographs through the port; false: photographs in air
  Words options;     // options of DensifyPointCloud, besides those of input and port
  // The clouds of every method are measured. True: the depth maps on true poses and, on COLMAP's
  // poses, the completeness for each of kCompletenessViews are measured, too.
  bool judged_closely;
};

const std::array<Method, 5>& all_methods() {
  static const std::array<Method, 5> all{
      {{"air", false, {}, true},
       {"ours", true, {}, true},
       {"line_search", true, {"--projection", "line-search"}, false},
       {"homography", true, {"--warp", "homography"}, false},
       {"papers", true, {"--projection", "line-search", "--warp", "homography"}, true}}};
  return all;
}

// Completeness is measured once for each of these numbers n, for the places that at least n cameras
// under water see. Numbers above the number of cameras are left out.
constexpr std::array<std::size_t, 4> kCompletenessViews{2, 3, 4, 5};

constexpr int kPhotographWidth = 480;

struct Study {
  SceneOptions scene;
  EvaluationOptions evaluation;
  std::vector<int> seeds;
  std::vector<Method> methods, on_true_poses;
};

Study study(bool quick) {
  Study all;
  all.scene.width = quick ? 320 : 2048;
  all.scene.height = quick ? 240 : 1536;
  all.scene.views = quick ? 4 : 10;
  all.scene.coarseness = quick ? 4 : 1;
  for (Method method : all_methods()) {
    // The matcher of the paper's method is slow.
    if (quick) method.options += {"--geometric-iters", "1"};
    all.methods.push_back(method);
    if (!quick || method.judged_closely) all.on_true_poses.push_back(method);
  }
  all.evaluation.samples = quick ? 5000 : 200000;
  all.evaluation.picture_width = quick ? 160 : 480;
  all.evaluation.color_max = quick ? 0.010 : 0.004;
  all.seeds = quick ? std::vector{1} : std::vector{1, 2, 3};
  return all;
}

std::string dense_name(const std::string& poses, const Method& method) {
  return poses + "-" + method.name;
}

// Removes the clouds of a finished part. An interrupted run needs them.
void remove_clouds(const std::string& poses, const SimulatedScene& scene) {
  for (const Method& method : all_methods())
    std::filesystem::remove_all(scene.folder / dense_name(poses, method));
}

DenseOptions options_of(const SimulatedScene& scene, const Method& method) {
  DenseOptions options;
  if (method.in_water) options.housing = scene.housing();
  options.more = method.options;
  return options;
}

std::filesystem::path dense_of(const Chain& chain, const std::string& poses,
                               const SimulatedScene& scene, const std::filesystem::path& model,
                               const Method& method) {
  return densified(chain, dense_name(poses, method), scene, model,
                   method.in_water ? "water" : "air", options_of(scene, method));
}

// Errors of the cloud in place, and after the best rigid motion, because the paper registered its
// clouds.
Json cloud_errors(const Chain& chain, const std::filesystem::path& dense,
                  const SimulatedScene& scene, EvaluationOptions evaluation) {
  Json result = evaluated(chain, dense, scene, evaluation);
  evaluation.icp = true;
  evaluation.picture_width = 0;
  result["moved"] = evaluated(chain, dense, scene, evaluation);
  return result;
}

// Completeness by the least number of underwater cameras that see a place, up to the number of
// cameras. `cloud`: the cloud's evaluation for the study's own number.
Json completeness(const Chain& chain, const std::filesystem::path& dense,
                  const SimulatedScene& scene, const Study& study, const Json& cloud) {
  Json result{{std::to_string(study.evaluation.min_views), cloud.at("recall")}};
  EvaluationOptions evaluation = study.evaluation;
  evaluation.picture_width = 0;
  for (const std::size_t views : kCompletenessViews) {
    if (views > static_cast<std::size_t>(study.scene.views)) continue;
    if (views == study.evaluation.min_views) continue;
    evaluation.min_views = views;
    result[std::to_string(views)] = evaluated(chain, dense, scene, evaluation).at("recall");
  }
  return result;
}

// Evaluation of the maps fused with --number-views-fuse 2, for places that two underwater cameras
// see.
Json fused_for_two(const Chain& chain, const std::filesystem::path& dense,
                   const SimulatedScene& scene, const Study& study, const Method& method) {
  EvaluationOptions evaluation = study.evaluation;
  evaluation.picture_width = 0;
  evaluation.min_views = 2;
  const auto fused =
      fused_again(chain, dense, "two", options_of(scene, method), {"--number-views-fuse", "2"});
  return evaluated(chain, fused, scene, evaluation);
}

Json clouds_on_colmap_poses(const Chain& chain, const Study& study) {
  const SimulatedScene scene = simulated(chain, study.scene);
  const ColmapPoses poses = colmap_poses(chain, "colmap", scene, "air", true_lens(scene));
  if (poses.model.empty()) fail_in(scene.images("air"), "COLMAP found no poses");
  Json result{{"images", poses.images}, {"centre_rms", poses.centre_rms}};
  for (const char* medium : {"air", "water"})
    result["photographs"][medium] = photograph(scene, medium, kPhotographWidth);
  for (const Method& method : study.methods) {
    const auto dense = dense_of(chain, "colmap", scene, poses.model, method);
    Json& cloud = result["clouds"][method.name];
    cloud = cloud_errors(chain, dense, scene, study.evaluation);
    if (!method.judged_closely) continue;
    cloud["complete"] = completeness(chain, dense, scene, study, cloud);
    cloud["two"] = fused_for_two(chain, dense, scene, study, method);
  }
  remove_clouds("colmap", scene);
  return result;
}

void judge_maps(const Chain& chain, const Study& study, const SimulatedScene& scene,
                const Method& method, const std::filesystem::path& dense, Json& result) {
  const char* medium = method.in_water ? "water" : "air";
  result["maps"][method.name] = depth_errors(dense, scene, medium, study.evaluation.tolerance);
  result["pictures"][method.name] =
      depth_picture(chain, dense, scene, medium, study.evaluation.color_max);
}

Json maps_on_true_poses(const Chain& chain, const Study& study) {
  const SimulatedScene scene = simulated(chain, study.scene);
  const SceneDistances distances = scene_distances(scene, "water");
  Json result{{"scene_distance", distances.median}, {"range_ratio", distances.range_ratio}};
  for (const Method& method : study.on_true_poses) {
    const auto dense = dense_of(chain, "true", scene, scene.model(), method);
    result["clouds"][method.name] = evaluated(chain, dense, scene, study.evaluation);
    if (method.judged_closely) judge_maps(chain, study, scene, method, dense, result);
  }
  remove_clouds("true", scene);
  return result;
}

Json to_json(const std::vector<Method>& methods) {
  Json all = Json::object();
  for (const Method& method : methods) all[method.name] = method.options;
  return all;
}

std::vector<Part> parts(const Chain& chain, bool quick) {
  const Json programs = programs_of_the_chain();
  std::vector<Part> all;
  Study one = study(quick);
  for (const int seed : one.seeds) {
    one.scene.seed = seed;
    const auto inputs = [&](int version, const std::vector<Method>& methods) -> Json {
      return {{"version", version},
              {"programs", programs},
              {"scene", to_json(one.scene)},
              {"evaluation", to_json(one.evaluation)},
              {"methods", to_json(methods)}};
    };
    all.push_back({fmt::format("seed{}_colmap_poses", seed), inputs(5, one.methods),
                   [=] { return clouds_on_colmap_poses(chain, one); }});
    all.push_back({fmt::format("seed{}_true_poses", seed), inputs(5, one.on_true_poses),
                   [=] { return maps_on_true_poses(chain, one); }});
  }
  return all;
}

}  // namespace

Experiment reconstruction(const Chain& chain, bool quick) {
  return {"reconstruction", parts(chain, quick)};
}

}  // namespace axial::experiments
