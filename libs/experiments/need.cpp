// SPDX-License-Identifier: GPL-3.0-or-later
// Shows when a refractive model is needed: compares a known port with common practice, where COLMAP
// calibrates a lens from the underwater photographs and a pinhole engine uses it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "experiments/cells.h"
#include "experiments/chained.h"
#include "experiments/charts.h"
#include "experiments/judge.h"
#include "experiments/need_cases.h"
#include "experiments/tables.h"

namespace axial::experiments {
namespace {

Calibration calibration(const Chain& chain, const NeedCase& one, const SimulatedScene& scene) {
  if (!one.calibrated_in) return self_calibration(scene);
  const SimulatedScene first = simulated(chain, *one.calibrated_in);
  const ColmapPoses poses =
      colmap_poses(chain, "self-calibrated", first, "water", self_calibration(first));
  if (poses.model.empty()) fail("{}: COLMAP found no poses", first.images("water").string());
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
  if (quick) evaluation.samples = 20000;
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

double number(const Json& result, const char* field) {
  return result.at(field).get<double>();
}

Words row_of(const NeedCase& one, const Json& result) {
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
       "after the move / known port", "complete, known port [%]", "complete, self-calibrated [%]"}};
  for (const NeedCase& one : need_cases(quick))
    rows.push_back(row_of(one, result_of(results, one.name)));
  return markdown_table(rows);
}

// One panel for each series: the mean distance over the value `x` of each case.
LinePanel panel(const Json& results, const std::vector<NeedCase>& shown, const std::string& title,
                const std::function<double(const NeedCase&, const Json&)>& x) {
  Line ours{"known port, true poses", {}, {}}, today{"self-calibrated", {}, {}},
      moved{"self-calibrated, after a rigid move", {}, {}};
  std::vector<std::pair<double, const Json*>> sorted;
  for (const NeedCase& one : shown) {
    const Json& result = result_of(results, one.name);
    sorted.emplace_back(x(one, result), &result);
  }
  std::sort(sorted.begin(), sorted.end());
  const auto add = [](Line& line, double at, const Json& cloud) {
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
    std::vector<NeedCase> shown;
    for (const NeedCase& one : need_cases(quick))
      if (one.series == series || (with_usual && one.is_usual())) shown.push_back(one);
    return shown;
  };
  const auto value = [](double usual) {
    return [usual](const NeedCase& one, const Json&) { return one.is_usual() ? usual : one.value; };
  };
  const auto field = [](const char* name) {
    return [name](const NeedCase&, const Json& result) { return number(result, name); };
  };
  const auto distance = field("scene_distance"), range = field("range_ratio");
  std::vector<LinePanel> panels;
  const auto add = [&](const std::vector<NeedCase>& shown, const char* title, const auto& x) {
    if (!shown.empty()) panels.push_back(panel(results, shown, title, x));
  };
  add(of("port_distance_mm", true), "lens to glass [mm]", value(20));
  add(of("scale", true), "distance of the scene [m]", distance);
  add(of("tilt_degrees", true), "tilt [degrees]", value(0));
  add(of("fov_degrees", true), "field of view [degrees]", value(80));
  add(of("relief", true), "far / near, the outcrop", range);
  add(of("reef_relief", false), "far / near, a reef from above", range);
  add(of("second_survey", false), "second survey: distance / first one's", value(1));
  return draw_lines("A known port on true poses beside a lens calibrated under water", panels, 3);
}

}  // namespace

Experiment need(const Chain& chain, bool quick) {
  return {"need", parts(chain, quick), [quick](const Json& results) {
            return std::vector<Document>{{"need.md", table(results, quick)},
                                         {"need.svg", chart(results, quick)}};
          }};
}

}  // namespace axial::experiments
