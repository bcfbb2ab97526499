// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/need_cases.h"

#include <fmt/format.h>

#include <initializer_list>

namespace axial::experiments {
namespace {

SceneOptions usual_scene() {
  SceneOptions scene;
  scene.scale = 0.5;
  scene.medium = "water";
  return scene;
}

Words port(double distance_mm, double tilt_degrees) {
  return {"--port-distance", fmt::format("{}", distance_mm / 1e3), "--tilt-degrees",
          fmt::format("{}", tilt_degrees)};
}

void shrink(SceneOptions& scene) {
  scene.width = 384;
  scene.height = 288;
  scene.views = 5;
  scene.coarseness = 4;
  scene.samples = 1;
}

std::vector<NeedCase> all_cases() {
  std::vector<NeedCase> cases{{"usual", usual_scene(), {}}};
  const auto add = [&](const char* series, std::initializer_list<double> values, auto change) {
    for (const double value : values) {
      cases.push_back({fmt::format("{}_{:g}", series, value), usual_scene(), {}});
      change(cases.back().scene, value);
    }
  };
  using Scene = SceneOptions&;
  add("port_distance_mm", {2, 50, 100}, [](Scene s, double mm) { s.port = port(mm, 0); });
  add("scale", {0.25, 1, 2}, [](Scene s, double scale) { s.scale = scale; });
  add("tilt_degrees", {1, 3, 6}, [](Scene s, double tilt) { s.port = port(20, tilt); });
  add("near_tilt_degrees", {6},
      [](Scene s, double tilt) { s.port = port(20, tilt), s.scale = 0.25; });
  add("fov_degrees", {50, 65, 95}, [](Scene s, double degrees) { s.fov_degrees = degrees; });
  // At the usual distance.
  add("reef_relief", {0.1, 1},
      [](Scene s, double relief) { s.preset = "reef", s.scale = 0.42, s.relief = relief; });
  add("relief", {0.3, 2}, [](Scene s, double relief) { s.relief = relief; });
  for (const char* preset : {"reef", "closeup"}) {
    cases.push_back({preset, usual_scene(), {}});
    SceneOptions& scene = cases.back().scene;
    scene.preset = preset;
    scene.scale = 1;
    if (scene.preset == "closeup") scene.views = 12;
  }
  for (const double factor : {0.5, 1.0, 2.0}) {
    cases.push_back({fmt::format("second_survey_{:g}", factor), usual_scene(), usual_scene()});
    cases.back().scene.scale *= factor;
    cases.back().scene.seed = 2;
  }
  return cases;
}

}  // namespace

std::vector<NeedCase> need_cases(bool quick) {
  std::vector<NeedCase> all = all_cases();
  if (!quick) return all;
  std::erase_if(all, [](const NeedCase& one) {
    return one.name != "usual" && one.name != "tilt_degrees_6" && one.name != "second_survey_0.5";
  });
  for (NeedCase& one : all) {
    shrink(one.scene);
    if (one.calibrated_in) shrink(*one.calibrated_in);
  }
  return all;
}

}  // namespace axial::experiments
