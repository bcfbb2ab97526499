// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's figure 4: mean errors of patches, at the paper's 100 x 100 pixels and at the size of
// real images.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/charts.h"
#include "experiments/experiment.h"
#include "experiments/patch_error.h"
#include "experiments/tables.h"
#include "experiments/verdicts.h"

namespace axial::experiments {
namespace {

constexpr int kPapersSize = 100, kRealSize = 2048;
constexpr std::array<const char*, kWarps> kTitles{"the paper's: Algorithm 1, nearest pixel",
                                                  "exact projection, nearest pixel",
                                                  "exact centre, f_v = f",
                                                  "local virtual scale, nearest pixel",
                                                  "local virtual scale, exact centre",
                                                  "first-order exact",
                                                  "every texel, float"};
constexpr std::array kMapped{Warp::kPapers, Warp::kFirstOrder};

std::vector<Series> series() {
  return {{"fov_degrees", {50, 80, 100, 110}}, {"distance_mm", {2, 20, 50, 100}},
          {"tilt_degrees", {0, 3, 6, 10}},     {"plane_degrees", {0, 20, 40, 60}},
          {"n_glass", {1.49, 1.52}},           {"n_water", {1.333, 1.34}}};
}

const char* warp_name(Warp warp) {
  return kWarpNames[static_cast<std::size_t>(warp)];
}

Json to_json(const StudyStatistics& statistics) {
  Json warps = Json::object();
  for (std::size_t w = 0; w < kWarps; ++w) {
    const WarpStatistics& warp = statistics.warps[w];
    warps[kWarpNames[w]] = {
        {"mean", warp.mean}, {"largest", warp.largest}, {"mean_at_centre", warp.mean_at_centre}};
  }
  return {{"centres", statistics.centres},
          {"warps", warps},
          {"rounding_over_warp", statistics.rounding_over_warp},
          {"papers_rounding_over_warp", statistics.papers_rounding_over_warp},
          {"middle_not_least", statistics.middle_not_least}};
}

// Whole millionths of a pixel: short in a file, and -1 stays -1.
Json whole_numbers(const std::vector<double>& map) {
  Json list = Json::array();
  for (const double value : map) list.push_back(value < 0 ? -1 : std::lround(1e6 * value));
  return list;
}

Json measure_papers_size(const StereoSetup& setup) {
  const WarpStudy study(setup, kPapersSize + 2 * kPatchReach, kPapersSize);
  Json result = to_json(study_statistics(study, 1));
  for (const Warp warp : kMapped)
    result["maps_in_millionths"][warp_name(warp)] = whole_numbers(patch_error_map(study, warp));
  return result;
}

Part papers_part(const Variation& variation) {
  const StereoSetup setup = variation.setup;
  return {
      part_name(variation.series, variation.value, setup.number) + "_100px",
      {{"version", 1}, {"setup", to_json(setup)}, {"size", kPapersSize}, {"border", kPatchReach}},
      [setup] { return measure_papers_size(setup); }};
}

Part real_part(const Variation& variation, int step) {
  const StereoSetup setup = variation.setup;
  return {part_name(variation.series, variation.value, setup.number) + "_2048px",
          {{"version", 1}, {"setup", to_json(setup)}, {"size", kRealSize}, {"step", step}},
          [setup, step] { return to_json(study_statistics(WarpStudy(setup, kRealSize), step)); }};
}

const Json& value_result(const Json& results, const Series& one, double value, int setup,
                         const char* size) {
  return result_of(results, part_name(one.name, value, setup) + size);
}

std::string maps_figure(const Json& results, int setup, Warp warp) {
  std::vector<MapPanel> panels;
  double highest = 0;
  for (const Series& one : series()) {
    for (const double value : one.values) {
      const Json& result = value_result(results, one, value, setup, "_100px");
      MapPanel panel{fmt::format("{}: mean {} px", value_title(one.name, value),
                                 significant(result.at("warps").at(warp_name(warp)).at("mean"))),
                     kPapersSize,
                     {}};
      for (const Json& v : result.at("maps_in_millionths").at(warp_name(warp)))
        panel.values.push_back(1e-6 * v.get<double>());
      highest = std::max(highest, *std::max_element(panel.values.begin(), panel.values.end()));
      panels.push_back(std::move(panel));
    }
  }
  return draw_maps(fmt::format("Mean patch error, 100 x 100 image, setup {}: {}", setup,
                               kTitles[static_cast<std::size_t>(warp)]),
                   panels, 4, highest, "px");
}

LinePanel means_panel(const Json& results, const Series& one, int setup) {
  LinePanel panel{
      fmt::format("setup {}", setup), series_title(one.name), "mean e_BH [px]", {}, true, true};
  for (std::size_t w = 0; w < kWarps; ++w) {
    Line line{kTitles[w], {}, {}};
    for (const double value : one.values) {
      line.x.push_back(value);
      line.y.push_back(value_result(results, one, value, setup, "_2048px")
                           .at("warps")
                           .at(kWarpNames[w])
                           .at("mean"));
    }
    panel.lines.push_back(line);
  }
  return panel;
}

std::string means_figure(const Json& results) {
  std::vector<LinePanel> panels;
  for (const int setup : {1, 2})
    for (const Series& one : series()) panels.push_back(means_panel(results, one, setup));
  return draw_lines("Mean patch error, 2048 x 2048 image", panels, series().size());
}

using Row = std::vector<std::string>;

template <class Cells>
std::string table(const Json& results, const char* size, const Row& header, Cells cells) {
  std::vector<Row> rows{{"setup", "varied", "value"}};
  rows[0].insert(rows[0].end(), header.begin(), header.end());
  for (const int setup : {1, 2}) {
    for (const Series& one : series()) {
      for (const double value : one.values) {
        Row row{fmt::format("{}", setup), series_title(one.name), fmt::format("{:g}", value)};
        const Row more = cells(value_result(results, one, value, setup, size));
        row.insert(row.end(), more.begin(), more.end());
        rows.push_back(row);
      }
    }
  }
  return markdown_table(rows);
}

std::string means_table(const Json& results, const char* size) {
  return table(results, size, Row(kTitles.begin(), kTitles.end()), [](const Json& result) {
    Row row;
    for (const char* name : kWarpNames)
      row.push_back(significant(result.at("warps").at(name).at("mean")));
    return row;
  });
}

// The parts of the error, and which part is larger.
std::string terms_table(const Json& results, const char* size) {
  const Row header{"patches",
                   "warp alone [px]",
                   "rounding alone, nearest pixel [px]",
                   "rounding alone, Algorithm 1 [px]",
                   "patches with more rounding than warp",
                   "the same, Algorithm 1",
                   "patches whose middle is not the best texel"};
  return table(results, size, header, [](const Json& result) {
    const Json& warps = result.at("warps");
    const auto percent = [&](const char* key) {
      return fmt::format("{:.0f} %", 100 * result.at(key).get<double>());
    };
    return Row{fmt::format("{}", result.at("centres").get<int>()),
               significant(warps.at("exact_centre").at("mean")),
               significant(warps.at("rounded").at("mean_at_centre")),
               significant(warps.at("papers").at("mean_at_centre")),
               percent("rounding_over_warp"),
               percent("papers_rounding_over_warp"),
               percent("middle_not_least")};
  });
}

// Mean errors [px] of a prototype that was written independently before this project, for 2048 x
// 2048 pixels and indices 1.52 and 1.333: the paper's warp (rounded lookup), the exact lookup with
// f_v = f, and the first-order exact warp.
struct Prototype {
  int setup;
  const char* series;
  double value;
  double rounded, exact_centre, first_order;
};
constexpr std::array<Prototype, 6> kPrototype{{{1, "fov_degrees", 80, 0.475, 0.454, 0.0022},
                                               {1, "fov_degrees", 100, 0.706, 0.685, 0.0034},
                                               {1, "distance_mm", 100, 0.462, 0.440, 0.0021},
                                               {1, "tilt_degrees", 6, 0.502, 0.481, 0.0024},
                                               {1, "plane_degrees", 40, 0.487, 0.463, 0.0025},
                                               {2, "fov_degrees", 80, 0.254, 0.205, 0.0010}}};

double mean_of(const Json& results, const std::string& part, Warp warp) {
  return result_of(results, part + "_2048px").at("warps").at(warp_name(warp)).at("mean");
}

double mean_beside(const Json& results, const Prototype& row, Warp warp) {
  return mean_of(results, part_name(row.series, row.value, row.setup), warp);
}

std::string prototype_table(const Json& results) {
  std::vector<Row> rows{
      {"setup", "varied", "value", "prototype's paper's warp", "exact projection, nearest pixel",
       "/ prototype's", "Algorithm 1, nearest pixel", "/ prototype's",
       "prototype's exact lookup, f_v = f", "ours", "prototype's first-order exact", "ours"}};
  for (const Prototype& row : kPrototype) {
    const auto ours = [&](Warp warp) { return mean_beside(results, row, warp); };
    const auto ratio = [&](Warp warp) { return fmt::format("{:.3f}", ours(warp) / row.rounded); };
    rows.push_back({fmt::format("{}", row.setup), series_title(row.series),
                    fmt::format("{:g}", row.value), significant(row.rounded),
                    significant(ours(Warp::kRounded)), ratio(Warp::kRounded),
                    significant(ours(Warp::kPapers)), ratio(Warp::kPapers),
                    significant(row.exact_centre), significant(ours(Warp::kExactCentre)),
                    significant(row.first_order, 2), significant(ours(Warp::kFirstOrder))});
  }
  return markdown_table(rows);
}

// Over both setups, at 80 degrees.
double largest_first_order_mean(const Json& results) {
  double largest = 0;
  for (const int setup : {1, 2})
    for (const Variation& one : variations(series(), setup))
      if (one.setup.camera.fov_degrees == 80)
        largest = std::max(
            largest, mean_of(results, part_name(one.series, one.value, setup), Warp::kFirstOrder));
  return largest;
}

double largest_deviation(const Json& results, Warp warp, int setup) {
  double largest = 0;
  for (const Prototype& row : kPrototype)
    if (row.setup == setup)
      largest = std::max(largest, std::abs(mean_beside(results, row, warp) / row.rounded - 1));
  return largest;
}

std::string verdicts(const Json& results) {
  const double ours = largest_first_order_mean(results);
  std::vector<Verdict> all{{"first-order exact, 2048 px, 80 degrees: every mean at most 0.005 px",
                            significant(ours) + " px", ours <= 0.005}};
  for (const Warp warp : {Warp::kRounded, Warp::kPapers})
    for (const int setup : {1, 2}) {
      const double deviation = largest_deviation(results, warp, setup);
      all.push_back({fmt::format("{}, setup {}: within 10 % of the prototype",
                                 kTitles[static_cast<std::size_t>(warp)], setup),
                     fmt::format("{:.1f} %", 100 * deviation), deviation <= 0.1});
    }
  return verdict_table(all);
}

std::vector<Document> documents(const Json& results) {
  std::vector<Document> all;
  for (const int setup : {1, 2})
    for (const Warp warp : kMapped)
      all.push_back({fmt::format("figure4_setup{}_{}.svg", setup, warp_name(warp)),
                     maps_figure(results, setup, warp)});
  all.push_back({"figure4_means.svg", means_figure(results)});
  all.push_back({"figure4_100px.md", means_table(results, "_100px")});
  all.push_back({"figure4_2048px.md", means_table(results, "_2048px")});
  all.push_back({"figure4_terms_100px.md", terms_table(results, "_100px")});
  all.push_back({"figure4_terms_2048px.md", terms_table(results, "_2048px")});
  all.push_back({"figure4_prototype.md", prototype_table(results)});
  all.push_back({"figure4_verdicts.md", verdicts(results)});
  return all;
}

}  // namespace

Experiment figure4(bool quick) {
  Experiment experiment{"figure4", {}, documents};
  for (const int setup : {1, 2}) {
    for (const Variation& variation : variations(series(), setup)) {
      experiment.parts.push_back(papers_part(variation));
      experiment.parts.push_back(real_part(variation, quick ? 61 : 7));
    }
  }
  return experiment;
}

}  // namespace axial::experiments
