// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/need_cases.h"

#include <fmt/format.h>

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

SceneOptions with_port(double distance_mm, double tilt_degrees) {
  SceneOptions scene = usual_scene();
  scene.port = port(distance_mm, tilt_degrees);
  return scene;
}

SceneOptions with_scale(double scale) {
  SceneOptions scene = usual_scene();
  scene.scale = scale;
  return scene;
}

SceneOptions with_fov(double degrees) {
  SceneOptions scene = usual_scene();
  scene.fov_degrees = degrees;
  return scene;
}

// The preset, scaled to the usual distance.
SceneOptions with_relief(const std::string& preset, double relief) {
  SceneOptions scene = usual_scene();
  scene.preset = preset;
  if (preset == "reef") scene.scale = 0.42;
  scene.relief = relief;
  return scene;
}

SceneOptions as_it_comes(const std::string& preset) {
  SceneOptions scene;
  scene.preset = preset;
  scene.views = preset == "closeup" ? 12 : 10;
  scene.medium = "water";
  return scene;
}

// A survey of other ground, with the distance multiplied by `factor`.
SceneOptions second_survey(double factor) {
  SceneOptions scene = with_scale(usual_scene().scale * factor);
  scene.seed = 2;
  return scene;
}

std::vector<NeedCase> all_cases() {
  std::vector<NeedCase> cases{{"usual", "usual", 0, usual_scene(), {}}};
  const auto add = [&](const char* series, double value, const SceneOptions& scene) {
    cases.push_back({fmt::format("{}_{:g}", series, value), series, value, scene, {}});
  };
  for (const double mm : {2.0, 50.0, 100.0}) add("port_distance_mm", mm, with_port(mm, 0));
  for (const double scale : {0.25, 1.0, 2.0}) add("scale", scale, with_scale(scale));
  for (const double degrees : {1.0, 3.0, 6.0}) add("tilt_degrees", degrees, with_port(20, degrees));
  SceneOptions near = with_port(20, 6);
  near.scale = 0.25;
  add("near_tilt_degrees", 6, near);
  for (const double degrees : {50.0, 65.0, 95.0}) add("fov_degrees", degrees, with_fov(degrees));
  for (const double relief : {0.1, 1.0}) add("reef_relief", relief, with_relief("reef", relief));
  for (const double relief : {0.3, 2.0}) add("relief", relief, with_relief("outcrop", relief));
  for (const char* preset : {"reef", "closeup"})
    cases.push_back({preset, preset, 0, as_it_comes(preset), {}});
  for (const double factor : {0.5, 1.0, 2.0})
    cases.push_back({fmt::format("second_survey_{:g}", factor), "second_survey", factor,
                     second_survey(factor), usual_scene()});
  return cases;
}

void shrink(SceneOptions& scene) {
  scene.width = 384;
  scene.height = 288;
  scene.views = 5;
  scene.coarseness = 4;
}

}  // namespace

std::vector<NeedCase> need_cases(bool quick) {
  std::vector<NeedCase> all = all_cases();
  if (!quick) return all;
  std::erase_if(all, [](const NeedCase& one) {
    return !one.is_usual() && one.name != "tilt_degrees_6" && one.name != "second_survey_0.5";
  });
  for (NeedCase& one : all) {
    shrink(one.scene);
    if (one.calibrated_in) shrink(*one.calibrated_in);
  }
  return all;
}

}  // namespace axial::experiments
