// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/report.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace axial::evaluate {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Histogram& histogram) {
  return {{"upper", histogram.upper}, {"counts", histogram.counts}, {"beyond", histogram.beyond}};
}

std::string recall_rows(const CloudEvaluation& e) {
  if (e.by_views.empty()) return {};
  std::vector<double> tolerances;
  for (const Score& s : e.scores) tolerances.push_back(s.tolerance);
  return table(std::span<const RecallOfViews>(e.by_views), tolerances);
}

}  // namespace

Json to_json(const CloudEvaluation& e) {
  return {{"accuracy", to_json(e.accuracy)},
          {"accuracy_histogram", to_json(e.accuracy_histogram)},
          {"completeness", to_json(e.completeness)},
          {"completeness_histogram", to_json(e.completeness_histogram)},
          {"scores", to_json(e.scores)},
          {"gross", {{"distance", e.gross}, {"share", e.gross_share}}},
          {"by_views", to_json(std::span<const RecallOfViews>(e.by_views))},
          {"views", e.views},
          {"samples", e.places.drawn},
          {"counted_samples", e.places.size()}};
}

Json to_json(const DepthEvaluation& e) {
  Json rings = Json::array();
  for (const Ring& ring : e.rings)
    rings.push_back({{"inner", ring.inner},
                     {"outer", ring.outer},
                     {"count", ring.count},
                     {"signed_median", ring.signed_median},
                     {"absolute_median", ring.absolute_median}});
  return {{"accuracy", to_json(e.accuracy)},
          {"accuracy_histogram", to_json(e.accuracy_histogram)},
          {"signed_mean", e.signed_mean},
          {"signed_median", e.signed_median},
          {"scores", to_json(e.scores)},
          {"truth_pixels", e.truth_pixels},
          {"estimated_pixels", e.estimated_pixels},
          {"compared_pixels", e.compared_pixels},
          {"completeness", e.completeness},
          {"rings", rings}};
}

Json to_json(const Similarity& similarity) {
  Json rows = Json::array();
  const Eigen::Matrix4d m = similarity.matrix();
  for (int r = 0; r < 4; ++r) rows.push_back({m(r, 0), m(r, 1), m(r, 2), m(r, 3)});
  return rows;
}

std::string table(const CloudEvaluation& e) {
  const std::string counted =
      e.views == 0
          ? fmt::format("all {} samples of the truth count (no cameras given)", e.places.drawn)
          : fmt::format("{} of {} samples of the truth are seen by enough of the {} views",
                        e.places.size(), e.places.drawn, e.views);
  return statistics_header("unsigned [mm, mm^2]") + statistics_row("points to truth", e.accuracy) +
         statistics_row("truth to points", e.completeness) + score_rows(e.scores) +
         fmt::format("{:.5f} of the points are farther than {:.3g} mm from the truth\n",
                     e.gross_share, e.gross * 1e3) +
         recall_rows(e) + counted + "\n";
}

std::string table(const DepthEvaluation& e) {
  std::string text = statistics_header("unsigned [mm, mm^2]") +
                     statistics_row("depth to truth", e.accuracy) + score_rows(e.scores);
  text += fmt::format(
      "signed mean {:.3f} mm, median {:.3f} mm; {} pixels have a truth, {} a depth, {} both "
      "(completeness {:.4f})\n",
      e.signed_mean * 1e3, e.signed_median * 1e3, e.truth_pixels, e.estimated_pixels,
      e.compared_pixels, e.completeness);
  text += fmt::format("{:<22}{:>10}{:>15}{:>17}\n", "ring [half diagonals]", "pixels",
                      "signed median", "unsigned median");
  for (const Ring& ring : e.rings)
    text += fmt::format("{:<22}{:>10}{:>15.3f}{:>17.3f}\n",
                        fmt::format("{:.3f} to {:.3f}", ring.inner, ring.outer), ring.count,
                        ring.signed_median * 1e3, ring.absolute_median * 1e3);
  return text;
}

nlohmann::ordered_json to_json(const DistanceStatistics& statistics) {
  nlohmann::ordered_json percentiles = nlohmann::ordered_json::object();
  for (std::size_t k = 0; k < kPercentiles.size(); ++k)
    percentiles[fmt::format("{:.0f}", kPercentiles[k])] = statistics.percentiles[k];
  return {{"count", statistics.count},       {"mean", statistics.mean},
          {"median", statistics.median},     {"rms", statistics.rms},
          {"variance", statistics.variance}, {"max", statistics.max},
          {"percentiles", percentiles}};
}

nlohmann::ordered_json to_json(const std::vector<Score>& scores) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Score& score : scores)
    list.push_back({{"tolerance", score.tolerance},
                    {"precision", score.precision},
                    {"recall", score.recall},
                    {"f_score", score.f_score}});
  return list;
}

std::string statistics_header(const char* title) {
  std::string text = fmt::format("{:<22}{:>10}{:>10}{:>10}{:>10}{:>12}", title, "count", "mean",
                                 "median", "RMS", "variance");
  for (const double p : kPercentiles) text += fmt::format("{:>9.0f}%", p);
  return text + fmt::format("{:>10}\n", "max");
}

std::string statistics_row(const char* name, const DistanceStatistics& s) {
  std::string text = fmt::format("{:<22}{:>10}{:>10.3f}{:>10.3f}{:>10.3f}{:>12.4g}", name, s.count,
                                 s.mean * 1e3, s.median * 1e3, s.rms * 1e3, s.variance * 1e6);
  for (const double value : s.percentiles) text += fmt::format("{:>10.3f}", value * 1e3);
  return text + fmt::format("{:>10.3f}\n", s.max * 1e3);
}

std::string score_rows(const std::vector<Score>& scores) {
  std::string text =
      fmt::format("{:<22}{:>10}{:>10}{:>10}\n", "tolerance [mm]", "precision", "recall", "F-score");
  for (const Score& s : scores)
    text += fmt::format("{:<22.3g}{:>10.4f}{:>10.4f}{:>10.4f}\n", s.tolerance * 1e3, s.precision,
                        s.recall, s.f_score);
  return text;
}

}  // namespace axial::evaluate
