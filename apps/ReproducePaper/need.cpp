// SPDX-License-Identifier: GPL-3.0-or-later
// When is a refractive model needed at all? What people do today, a lens that COLMAP calibrates
// from the photographs under water and a pinhole engine that believes it, beside a known port.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/error.h"
#include "chained.h"
#include "experiments/charts.h"
#include "experiments/tables.h"

namespace axial {
namespace {

using experiments::Document;
using experiments::Experiment;
using experiments::Part;
using experiments::result_of;

struct Case {
  std::string name;    // of the part
  std::string series;  // what is varied
  double value;
  SceneOptions scene;
  // The lens was calibrated in this scene, before, and is not calibrated again.
  std::optional<SceneOptions> calibrated_in;
};

constexpr const char* kUsual = "usual";

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

// `preset` at the usual distance.
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

// Other ground, at another distance.
SceneOptions second_survey(double factor) {
  SceneOptions scene = with_scale(usual_scene().scale * factor);
  scene.seed = 2;
  return scene;
}

std::vector<Case> all_cases() {
  std::vector<Case> cases{{kUsual, "usual", 0, usual_scene(), {}}};
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

// Quick: the usual case, one that is worse, and one second survey.
std::vector<Case> cases(bool quick) {
  std::vector<Case> all = all_cases();
  if (!quick) return all;
  std::erase_if(all, [](const Case& one) {
    return one.name != kUsual && one.name != "tilt_degrees_6" && one.name != "second_survey_0.5";
  });
  for (Case& one : all) {
    shrink(one.scene);
    if (one.calibrated_in) shrink(*one.calibrated_in);
  }
  return all;
}

Calibration calibration(const Chain& chain, const Case& one, const SimulatedScene& scene) {
  if (!one.calibrated_in) return self_calibration(scene);
  const SimulatedScene first = simulated(chain, *one.calibrated_in);
  const ColmapPoses poses =
      colmap_poses(chain, "self-calibrated", first, "water", self_calibration(first));
  if (poses.model.empty()) fail("{}: COLMAP found no poses", first.images("water").string());
  return calibration_of(poses.model);
}

// Of whatever COLMAP makes of the images: cameras that have little to do with the true ones may
// leave nothing to match or to measure.
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

Json without_refraction(const Chain& chain, const Case& one, const SimulatedScene& scene,
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

Json measure(const Chain& chain, const Case& one, const EvaluationOptions& evaluation) {
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
  if (quick) evaluation.samples = 20000;
  std::vector<Part> all;
  for (const Case& one : cases(quick)) {
    Json inputs{{"version", 2}, {"scene", to_json(one.scene)}, {"evaluation", to_json(evaluation)}};
    if (one.calibrated_in) inputs["calibrated_in"] = to_json(*one.calibrated_in);
    all.push_back({one.name, inputs, [=] { return measure(chain, one, evaluation); }});
  }
  return all;
}

// What the reader sees.

std::string title_of(const Case& one) {
  const auto value = [&](const char* format) {
    return fmt::format(fmt::runtime(format), one.value);
  };
  if (one.series == "port_distance_mm") return value("lens to glass {:g} mm");
  if (one.series == "scale") return value("everything but the port, times {:g}");
  if (one.series == "tilt_degrees") return value("tilt {:g}\u00b0");
  if (one.series == "near_tilt_degrees")
    return value("everything but the port, times 0.25, and tilt {:g}\u00b0");
  if (one.series == "fov_degrees") return value("field of view {:g}\u00b0");
  if (one.series == "reef_relief") return value("seen from above, heights times {:g}");
  if (one.series == "relief") return value("heights times {:g}");
  if (one.series == "second_survey") return value("second survey, distance times {:g}");
  if (one.series == "usual") return "the usual case";
  return "scene '" + one.series + "' as it comes";
}

double number(const Json& result, const char* field) {
  return result.at(field).get<double>();
}

Words row_of(const Case& one, const Json& result) {
  const double distance = number(result, "scene_distance");
  const Json &ours = result.at("ours"), &today = result.at("today");
  const auto field = [&](const char* how, const char* name) {
    return today.at(how).is_null() ? Json() : today.at(how).at(name);
  };
  const Json moved = field("moved", "mean");
  return {title_of(one),
          fmt::format("{:.2f}", distance),
          fmt::format("{:.2f}", number(result, "range_ratio")),
          fmt::format("{:.3f}", number(result, "port_distance") / distance),
          fmt::format("{:.1f}", number(result, "tilt_degrees")),
          fmt::format("{:g}", number(result, "fov_degrees")),
          millimetres(ours.at("mean")),
          fmt::format("{} of {}", today.at("images").get<std::size_t>(), one.scene.views),
          millimetres(today.at("centre_rms")),
          millimetres(field("as_it_lies", "mean")),
          millimetres(moved),
          moved.is_null() ? "-" : fmt::format("{:.2f}", moved.get<double>() / number(ours, "mean")),
          percent(ours.at("recall")),
          percent(field("moved", "recall"))};
}

std::string table(const Json& results, bool quick) {
  std::vector<Words> rows{
      {"case", "scene distance [m]", "far / near", "glass / scene distance", "tilt [degrees]",
       "field of view [degrees]", "known port on true poses: mean [mm]", "self-calibrated: images",
       "camera centres, RMS [mm]", "mean [mm]", "mean after a rigid move [mm]",
       "/ known port (upper bound)", "complete, known port [%]", "complete, self-calibrated [%]"}};
  for (const Case& one : cases(quick)) rows.push_back(row_of(one, result_of(results, one.name)));
  return experiments::markdown_table(rows);
}

// One panel a series: the mean distance over what `x` says of a case.
experiments::LinePanel panel(const Json& results, const std::vector<Case>& shown,
                             const std::string& title,
                             const std::function<double(const Case&, const Json&)>& x) {
  experiments::Line ours{"known port, true poses", {}, {}}, today{"self-calibrated", {}, {}},
      moved{"self-calibrated, after a rigid move", {}, {}};
  std::vector<std::pair<double, const Json*>> sorted;
  for (const Case& one : shown) {
    const Json& result = result_of(results, one.name);
    sorted.emplace_back(x(one, result), &result);
  }
  std::sort(sorted.begin(), sorted.end());
  const auto add = [](experiments::Line& line, double at, const Json& cloud) {
    if (cloud.is_null()) return;
    line.x.push_back(at);
    line.y.push_back(1e3 * number(cloud, "mean"));
  };
  for (const auto& [at, result] : sorted) {
    add(ours, at, result->at("ours"));
    add(today, at, result->at("today").at("as_it_lies"));
    add(moved, at, result->at("today").at("moved"));
  }
  return {"", title, "mean distance [mm]", {ours, today, moved}, true, true};
}

std::string chart(const Json& results, bool quick) {
  const auto of = [&](const char* series, bool with_usual) {
    std::vector<Case> shown;
    for (const Case& one : cases(quick))
      if (one.series == series || (with_usual && one.name == kUsual)) shown.push_back(one);
    return shown;
  };
  const auto value = [](double usual) {
    return [usual](const Case& one, const Json&) { return one.name == kUsual ? usual : one.value; };
  };
  const auto field = [](const char* name) {
    return [name](const Case&, const Json& result) { return number(result, name); };
  };
  const auto distance = field("scene_distance"), range = field("range_ratio");
  std::vector<experiments::LinePanel> panels;
  const auto add = [&](const std::vector<Case>& shown, const char* title, const auto& x) {
    if (!shown.empty()) panels.push_back(panel(results, shown, title, x));
  };
  add(of("port_distance_mm", true), "lens to glass [mm]", value(20));
  add(of("scale", true), "distance of the scene [m]", distance);
  add(of("tilt_degrees", true), "tilt [degrees]", value(0));
  add(of("fov_degrees", true), "field of view [degrees]", value(80));
  add(of("relief", true), "far / near, the outcrop", range);
  add(of("reef_relief", false), "far / near, a reef from above", range);
  add(of("second_survey", false), "second survey: distance / first one's", value(1));
  return experiments::draw_lines("A known port on true poses beside a lens calibrated under water",
                                 panels, 3);
}

}  // namespace

Experiment need(const Chain& chain, bool quick) {
  return {"need", parts(chain, quick), [quick](const Json& results) {
            return std::vector<Document>{{"need.md", table(results, quick)},
                                         {"need.svg", chart(results, quick)}};
          }};
}

}  // namespace axial
