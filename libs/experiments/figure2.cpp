// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's figure 2: the errors of Algorithm 1, and of the exact projection.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "experiments/charts.h"
#include "experiments/experiment.h"
#include "experiments/projection_error.h"
#include "experiments/tables.h"
#include "experiments/verdicts.h"

namespace axial::experiments {
namespace {

constexpr int kSize = 1000;

std::vector<Series> series() {
  return {{"fov_degrees", {50, 80, 100, 120}},
          {"distance_mm", {2, 20, 50, 100}},
          {"tilt_degrees", {0, 5, 10, 20}},
          {"n_glass", {1.49, 1.52}},
          {"n_water", {1.333, 1.34}}};
}

Json to_json(const RoundTrips& trips) {
  const Distribution& errors = trips.errors;
  return {{"mean", errors.mean()},         {"median", errors.quantile(0.5)},
          {"p95", errors.quantile(0.95)},  {"largest", errors.largest()},
          {"count", errors.count()},       {"missed", trips.missed},
          {"bins_upper", errors.upper()},  {"bins", errors.counts()},
          {"beyond_bins", errors.beyond()}};
}

Part make_part(const Variation& variation, double step) {
  const CameraSetup camera = variation.setup.camera;
  return {part_name(variation.series, variation.value, 1),
          {{"version", 1}, {"camera", to_json(camera)}, {"size", kSize}, {"step", step}},
          [camera, step]() -> Json {
            const ProjectionErrors errors = projection_errors(camera, kSize, step);
            return {{"line_search", to_json(errors.line_search)}, {"exact", to_json(errors.exact)}};
          }};
}

// Number of bins that are drawn as one: errors in float are multiples of a coordinate's last bit.
constexpr std::size_t kDrawnBins = 10;

// Density of the errors, in units of `unit` pixels.
Line density(const std::string& name, const Json& method, double unit) {
  Line line{name, {}, {}};
  const auto bins = method.at("bins").get<std::vector<double>>();
  const double width =
      kDrawnBins * method.at("bins_upper").get<double>() / static_cast<double>(bins.size()) / unit;
  for (std::size_t k = 0; k + kDrawnBins <= bins.size(); k += kDrawnBins) {
    const double sum =
        std::accumulate(bins.begin() + static_cast<std::ptrdiff_t>(k),
                        bins.begin() + static_cast<std::ptrdiff_t>(k + kDrawnBins), 0.0);
    line.x.push_back((static_cast<double>(k / kDrawnBins) + 0.5) * width);
    line.y.push_back(sum / method.at("count").get<double>() / width);
  }
  return line;
}

LinePanel panel(const Json& results, const Series& one, const std::string& method, double unit,
                const std::string& x_title) {
  LinePanel panel{method == "exact" ? "exact projection, float" : "Algorithm 1",
                  x_title,
                  "density",
                  {},
                  false,
                  false};
  for (const double value : one.values) {
    const Json& result = result_of(results, part_name(one.name, value, 1)).at(method);
    panel.lines.push_back(density(fmt::format("{}: mean {} px", value_title(one.name, value),
                                              significant(result.at("mean"), 3)),
                                  result, unit));
  }
  return panel;
}

// "positions 0.1 px apart"; all parts have the same step.
std::string sampling(const Json& results) {
  const Json& inputs = results.at("parts").front().at("inputs");
  return fmt::format("{0} x {0} image, positions {1:g} px apart", inputs.at("size").get<int>(),
                     inputs.at("step").get<double>());
}

std::string figure(const Json& results) {
  std::vector<LinePanel> panels;
  for (const Series& one : series())
    panels.push_back(panel(results, one, "line_search", 1, "error [px]"));
  for (const Series& one : series())
    panels.push_back(panel(results, one, "exact", 1e-6, "error [millionths of a pixel]"));
  return draw_lines("Reprojection error, " + sampling(results), panels, series().size());
}

std::string table(const Json& results) {
  std::vector<std::vector<std::string>> rows{
      {"varied", "value", "Algorithm 1: mean [px]", "median", "95 %", "largest", "missed",
       "exact, float: mean [px]", "95 %", "largest", "missed"}};
  for (const Series& one : series()) {
    for (const double value : one.values) {
      const Json& result = result_of(results, part_name(one.name, value, 1));
      const Json& papers = result.at("line_search");
      const Json& exact = result.at("exact");
      const auto of = [](const Json& method, const char* key) {
        return significant(method.at(key));
      };
      const auto missed = [](const Json& method) {
        return fmt::format("{}", method.at("missed").get<std::int64_t>());
      };
      rows.push_back({series_title(one.name), fmt::format("{:g}", value), of(papers, "mean"),
                      of(papers, "median"), of(papers, "p95"), of(papers, "largest"),
                      missed(papers), of(exact, "mean"), of(exact, "p95"), of(exact, "largest"),
                      missed(exact)});
    }
  }
  return markdown_table(rows) + "\n(" + sampling(results) + ")\n";
}

std::string verdicts(const Json& results) {
  double least = HUGE_VAL, most = 0, ours = 0;
  for (const Json& part : results.at("parts")) {
    const Json& result = part.at("result");
    const auto mean = result.at("line_search").at("mean").get<double>();
    least = std::min(least, mean);
    most = std::max(most, mean);
    ours = std::max(ours, result.at("exact").at("largest").get<double>());
  }
  return verdict_table({{"Algorithm 1: mean of 0.24 to 0.29 px for every value",
                         fmt::format("{} to {} px", significant(least), significant(most)),
                         least >= 0.24 && most <= 0.29},
                        {"exact projection, float: every error below 0.001 px",
                         significant(ours) + " px", ours < 1e-3}});
}

}  // namespace

Experiment figure2(bool quick) {
  Experiment experiment{"figure2", {}, [](const Json& results) -> std::vector<Document> {
                          return {{"figure2.svg", figure(results)},
                                  {"figure2.md", table(results)},
                                  {"figure2_verdicts.md", verdicts(results)}};
                        }};
  // Coarse steps still cover every tenth of a pixel.
  for (const Variation& variation : variations(series(), 1))
    experiment.parts.push_back(make_part(variation, quick ? 1.7 : 0.1));
  return experiment;
}

}  // namespace axial::experiments
