// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/report_rows.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace axial::evaluate {

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
