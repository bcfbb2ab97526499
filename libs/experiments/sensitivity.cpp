// SPDX-License-Identifier: GPL-3.0-or-later
// Sensitivity of clouds to a wrong housing file: true poses, but a port that differs from the file.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <numbers>

#include "experiments/chained.h"
#include "experiments/judge.h"
#include "io/cameras/housing.h"

namespace axial::experiments {
namespace {

// The errors of the housing file. All zero: none.
struct Mistake {
  std::string name;  // end of the part's name
  double distance = 0, thickness = 0, tilt_degrees = 0, n_water = 0;
};

std::vector<Mistake> mistakes() {
  return {{"none", 0, 0, 0, 0},
          {"distance_1mm", 0.001, 0, 0, 0},
          {"distance_5mm", 0.005, 0, 0, 0},
          {"distance_20mm", 0.020, 0, 0, 0},
          {"tilt_0.1", 0, 0, 0.1, 0},
          {"tilt_0.5", 0, 0, 0.5, 0},
          {"tilt_2", 0, 0, 2, 0},
          {"n_water_0.005", 0, 0, 0, 0.005},
          {"thickness_2mm", 0, 0.002, 0, 0}};
}

Json to_json(const Mistake& mistake) {
  return {{"distance", mistake.distance},
          {"thickness", mistake.thickness},
          {"tilt_degrees", mistake.tilt_degrees},
          {"n_water", mistake.n_water}};
}

FlatPort<double> wrong_port(FlatPort<double> port, const Mistake& mistake) {
  port.distance += mistake.distance;
  port.thickness += mistake.thickness;
  port.n_water += mistake.n_water;
  const double radians = mistake.tilt_degrees * std::numbers::pi / 180;
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitY();
  port.normal = Eigen::AngleAxisd(radians, axis) * port.normal;
  return port;
}

// Near: a distance of about a metre, as for photographs of a coral. Far: as for a survey.
struct Distance {
  const char* name;
  double scale;
};
constexpr std::array<Distance, 2> kDistances{{{"near", 0.4}, {"far", 1.0}}};

struct Study {
  SceneOptions scene;
  EvaluationOptions evaluation;
};

Study study(bool quick, const Distance& distance) {
  Study one;
  one.scene.scale = distance.scale;
  one.scene.medium = "water";
  if (quick) {
    one.scene.width = 256;
    one.scene.height = 192;
    one.scene.views = 4;
    one.scene.coarseness = 4;
    one.scene.samples = 1;
    one.evaluation.samples = 5000;
  }
  return one;
}

std::string part_name(const Distance& distance, const Mistake& mistake) {
  return fmt::format("{}_{}", distance.name, mistake.name);
}

Json measure(const Chain& chain, const Study& study, const Mistake& mistake) {
  const SimulatedScene scene = simulated(chain, study.scene);
  io::Housing housing = io::read_housing(scene.housing());
  for (auto& [name, port] : housing.ports)
    port = wrong_port(std::get<FlatPort<double>>(port), mistake);
  const std::filesystem::path file = scene.folder / (mistake.name + ".housing.json");
  io::write_housing(file, housing);
  const auto dense = densified(chain, mistake.name, scene, scene.model(), "water", {file, {}});
  const SceneDistances distances = scene_distances(scene, "water");
  Json result{{"scene_distance", distances.median}, {"range_ratio", distances.range_ratio}};
  EvaluationOptions evaluation = study.evaluation;
  result["as_it_lies"] = evaluated(chain, dense, scene, evaluation);
  evaluation.icp = true;
  result["moved"] = evaluated(chain, dense, scene, evaluation);
  std::filesystem::remove_all(dense);
  return result;
}

// `quick`: the near distance, without a mistake and with the largest mistakes of two kinds.
bool is_quick(const Distance& distance, const Mistake& mistake) {
  const bool largest =
      mistake.name == "none" || mistake.name == "distance_20mm" || mistake.name == "tilt_2";
  return distance.name == std::string_view("near") && largest;
}

struct Row {
  Distance distance;
  Mistake mistake;
};

std::vector<Row> rows_of(bool quick) {
  std::vector<Row> rows;
  for (const Distance& distance : kDistances)
    for (const Mistake& mistake : mistakes())
      if (!quick || is_quick(distance, mistake)) rows.push_back({distance, mistake});
  return rows;
}

std::vector<Part> parts(const Chain& chain, bool quick) {
  const Json programs = programs_of_the_chain();
  std::vector<Part> all;
  for (const auto& [distance, mistake] : rows_of(quick)) {
    const Study one = study(quick, distance);
    const Json inputs{{"version", 1},
                      {"programs", programs},
                      {"scene", to_json(one.scene)},
                      {"evaluation", to_json(one.evaluation)},
                      {"mistake", to_json(mistake)}};
    all.push_back({part_name(distance, mistake), inputs,
                   [chain, one, mistake = mistake] { return measure(chain, one, mistake); }});
  }
  return all;
}

}  // namespace

Experiment sensitivity(const Chain& chain, bool quick) {
  return {"sensitivity", parts(chain, quick)};
}

}  // namespace axial::experiments
