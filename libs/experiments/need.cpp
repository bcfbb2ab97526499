// SPDX-License-Identifier: GPL-3.0-or-later
// Shows when a refractive model is needed: compares a known port with common practice, where COLMAP
// calibrates a lens from the underwater photographs and a pinhole engine uses it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "experiments/chained.h"
#include "experiments/judge.h"
#include "experiments/need_cases.h"

namespace axial::experiments {
namespace {

Calibration calibration(const Chain& chain, const NeedCase& one, const SimulatedScene& scene) {
  if (!one.calibrated_in) return self_calibration(scene);
  const SimulatedScene first = simulated(chain, *one.calibrated_in);
  const ColmapPoses poses =
      colmap_poses(chain, "self-calibrated", first, "water", self_calibration(first));
  if (poses.model.empty()) fail_in(first.images("water"), "COLMAP found no poses");
  return calibration_of(poses.model);
}

// Evaluation of the clouds from COLMAP's poses. If the poses are far from the true ones there may
// be nothing to match or to measure.
Json clouds_of_today(const Chain& chain, const SimulatedScene& scene,
                     const std::filesystem::path& model, EvaluationOptions evaluation) {
  Json clouds{{"as_it_lies", nullptr}, {"moved", nullptr}};
  const auto dense = densified(chain, "today-dense", scene, model, "water", {{}, {}, true});
  if (dense.empty()) return clouds;
  evaluation.or_nothing = true;
  clouds["as_it_lies"] = evaluated(chain, dense, scene, evaluation);
  evaluation.icp = true;
  clouds["moved"] = evaluated(chain, dense, scene, evaluation);
  return clouds;
}

Json without_refraction(const Chain& chain, const NeedCase& one, const SimulatedScene& scene,
                        const EvaluationOptions& evaluation) {
  const ColmapPoses poses =
      colmap_poses(chain, "today", scene, "water", calibration(chain, one, scene));
  Json result{{"images", poses.images},
              {"centre_rms", nullptr},
              {"as_it_lies", nullptr},
              {"moved", nullptr}};
  if (poses.model.empty()) return result;
  result["centre_rms"] = poses.centre_rms;
  result.update(clouds_of_today(chain, scene, poses.model, evaluation));
  return result;
}

double tilt_degrees(const refractive::FlatPort<double>& port) {
  return std::acos(std::min(1.0, port.normal.z())) * 180 / std::numbers::pi;
}

Json measure(const Chain& chain, const NeedCase& one, const EvaluationOptions& evaluation) {
  const SimulatedScene scene = simulated(chain, one.scene);
  const SceneDistances distances = scene_distances(scene, "water");
  const auto dense = densified(chain, "ours", scene, scene.model(), "water", {scene.housing(), {}});
  Json result{{"scene_distance", distances.median},
              {"range_ratio", distances.range_ratio},
              {"port_distance", port_of(scene).distance},
              {"tilt_degrees", tilt_degrees(port_of(scene))},
              {"fov_degrees", one.scene.fov_degrees},
              {"ours", evaluated(chain, dense, scene, evaluation)},
              {"today", without_refraction(chain, one, scene, evaluation)}};
  std::filesystem::remove_all(scene.folder);
  return result;
}

std::vector<Part> parts(const Chain& chain, bool quick) {
  EvaluationOptions evaluation;
  if (quick) evaluation.samples = 5000;
  const Json programs = programs_of_the_chain();
  std::vector<Part> all;
  for (const NeedCase& one : need_cases(quick)) {
    Json inputs{{"version", 2},
                {"programs", programs},
                {"scene", to_json(one.scene)},
                {"evaluation", to_json(evaluation)}};
    if (one.calibrated_in) inputs["calibrated_in"] = to_json(*one.calibrated_in);
    all.push_back({one.name, inputs, [=] { return measure(chain, one, evaluation); }});
  }
  return all;
}

}  // namespace

Experiment need(const Chain& chain, bool quick) {
  return {"need", parts(chain, quick)};
}

}  // namespace axial::experiments
