// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/completeness.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "experiments/cells.h"
#include "experiments/distribution.h"
#include "experiments/steps.h"
#include "experiments/tables.h"

namespace axial::experiments {
namespace {

namespace fs = std::filesystem;

bool is_near(const std::string& preset) {
  return preset.starts_with("closeup") || preset.starts_with("thicket");
}

bool is_strip(const std::string& preset) {
  return preset.starts_with("transect");
}

double tolerance_of(const CompletenessOptions& options) {
  if (options.tolerance > 0) return options.tolerance;
  return is_near(options.preset) ? 0.002 : 0.005;
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
  if (poses.model.empty()) fail("{}: COLMAP found no poses", scene.images("air").string());
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

// A number of a seed's result; NaN if the result does not have it.
using Value = std::function<double(const Json& result)>;

double number(const Json& value) {
  return value.is_number() ? value.get<double>() : NAN;
}

struct Column {
  std::string title;
  const char* format;
  double scale;
  Value value;
};

Value of_score(const char* field) {
  return [=](const Json& result) { return number(result.at("scores").at(0).at(field)); };
}

// The recall of the k-th class in `list`.
Value of_class(const char* list, std::size_t k) {
  return [=](const Json& result) { return number(result.at(list).at(k).at("recall").at(0)); };
}

std::vector<Column> columns_for(const Json& any) {
  std::vector<Column> columns{
      {"seen by 2 [%]", "{:.1f}", 100, of_class("by_views", 0)},
      {"by 3 [%]", "{:.1f}", 100, of_class("by_views", 1)},
      {"by 4 or more [%]", "{:.1f}", 100, of_class("by_views", 2)},
      {"precision [%]", "{:.1f}", 100, of_score("precision")},
      {"F", "{:.3f}", 1, of_score("f_score")},
      {"mean [mm]", "{:.3f}", 1e3,
       [](const Json& r) { return number(r.at("accuracy").at("mean")); }},
      {"gross [%]", "{:.3f}", 100, [](const Json& r) { return number(r.at("gross").at("share")); }},
      {"points", "{:.0f}", 1, [](const Json& r) { return number(r.at("accuracy").at("count")); }}};
  if (any.contains("points_by_views"))
    columns.push_back({"of 2 maps [%]", "{:.1f}", 100, [](const Json& r) {
                         return number(r.at("points_by_views").at(0).at("share"));
                       }});
  if (any.contains("points_by_views"))
    columns.push_back({"their mean [mm]", "{:.3f}", 1e3, [](const Json& r) {
                         return number(r.at("points_by_views").at(0).at("mean"));
                       }});
  if (any.contains("calibration"))
    columns.push_back({"error / expected, RMS", "{:.3f}", 1,
                       [](const Json& r) { return number(r.at("calibration").at("rms")); }});
  if (any.contains("strip"))
    columns.push_back({"density, most / least", "{:.2f}", 1,
                       [](const Json& r) { return number(r.at("strip").at("ratio")); }});
  columns.push_back(
      {"CPU [s]", "{:.1f}", 1, [](const Json& r) { return number(r.at("cpu_seconds")); }});
  return columns;
}

// One column for each class of thickness.
std::vector<Column> thickness_columns(const Json& any) {
  std::vector<Column> columns;
  const Json& classes = any.at("by_thickness");
  for (std::size_t k = 0; k < classes.size(); ++k) {
    const Json &least = classes[k].at("least"), &most = classes[k].at("most");
    const std::string title =
        least.is_null()  ? "not thin [%]"
        : most.is_null() ? fmt::format("from {:.1f} px [%]", number(least))
                         : fmt::format("{:.1f} to {:.1f} px [%]", number(least), number(most));
    columns.push_back({title, "{:.1f}", 100, of_class("by_thickness", k)});
  }
  return columns;
}

std::string cell(const Column& column, double value) {
  if (std::isnan(value)) return "-";
  return fmt::format(fmt::runtime(column.format), column.scale * value);
}

std::string table(const std::vector<Column>& columns, const std::vector<int>& seeds,
                  const Json& results) {
  std::vector<Words> rows{{"seed"}};
  for (const Column& column : columns) rows[0].push_back(column.title);
  std::vector<std::vector<double>> of_columns(columns.size());
  for (const int seed : seeds) {
    Words row{std::to_string(seed)};
    const Json& result = result_of(results, part_name(seed));
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const double value = columns[k].value(result);
      row.push_back(cell(columns[k], value));
      if (!std::isnan(value)) of_columns[k].push_back(value);
    }
    rows.push_back(row);
  }
  Words medians{"median"};
  for (std::size_t k = 0; k < columns.size(); ++k)
    medians.push_back(of_columns[k].empty() ? "-" : cell(columns[k], median_of(of_columns[k])));
  rows.push_back(medians);
  return markdown_table(rows);
}

std::string tables(const CompletenessOptions& options, const Json& results) {
  const Json& any = result_of(results, part_name(options.seeds.front()));
  std::string text =
      fmt::format("{}, {}, {} poses, tolerance {:g} mm; gross: beyond {:g} mm\n\n", options.preset,
                  options.medium, options.poses, 1e3 * tolerance_of(options),
                  1e3 * number(any.at("gross").at("distance")));
  text += table(columns_for(any), options.seeds, results);
  if (any.contains("by_thickness"))
    text.append("\n").append(table(thickness_columns(any), options.seeds, results));
  return text;
}

}  // namespace

std::string completeness_name(const CompletenessOptions& options) {
  return fmt::format("completeness_{}_{}_{}", options.preset, options.medium, options.poses);
}

std::vector<Document> completeness_documents(const CompletenessOptions& options,
                                             const Json& results) {
  return {{completeness_name(options) + ".md", tables(options, results)}};
}

Experiment completeness(const Chain& chain, const CompletenessOptions& options) {
  Experiment experiment{completeness_name(options), {}, {}};
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
  experiment.documents = [options](const Json& results) {
    return completeness_documents(options, results);
  };
  return experiment;
}

}  // namespace axial::experiments
