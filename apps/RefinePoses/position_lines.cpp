// SPDX-License-Identifier: GPL-3.0-or-later
#include "position_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace axial::apps {
namespace {

// Without positions that pull, adjustment cannot make the reprojection errors this much larger.
constexpr double kLargerErrors = 1.1;

// The estimated standard deviation [m]; 0 if all were stated.
double estimated_sigma(const pose::RefineReport& report) {
  const auto guess =
      std::ranges::find(report.positions, true, &pose::KnownPosition::sigma_is_guess);
  return guess == report.positions.end() ? 0 : guess->sigma.x();
}

}  // namespace

std::vector<std::string> position_lines(const pose::RefineReport& report) {
  if (report.positions.empty()) return {};
  const pose::PositionDistances& found = report.position_distances;
  std::string line =
      fmt::format("{} positions are {:.2g} m (RMS) from the cameras", found.count, found.rms);
  if (const double sigma = estimated_sigma(report); sigma > 0)
    line += fmt::format("; the standard deviation of their coordinates is estimated as {:.2g} m",
                        sigma);
  if (found.of_stated > 0)
    line +=
        fmt::format("; the standard deviation of their coordinates is {:.2g} times the stated one",
                    found.of_stated);
  return {line};
}

std::vector<std::string> position_warnings(const pose::RefineReport& report) {
  if (report.positions.empty()) return {};
  std::vector<std::string> lines;
  const double of_stated = report.position_distances.of_stated;
  if (of_stated > pose::kContradicted)
    lines.push_back(fmt::format(
        "The positions deviate {:.2g} times as much from the cameras as their stated standard "
        "deviation lets expect: state a larger one (--scale-sigma, or the accuracies in the file), "
        "or none, so that it is estimated",
        of_stated));
  if (report.rms_after > kLargerErrors * report.rms_before)
    lines.push_back(fmt::format(
        "The positions made the RMS reprojection error larger: {:.3f} px before, {:.3f} px after. "
        "They do not agree with the photographs, the lens and the housing{}",
        report.rms_before, report.rms_after,
        of_stated > 0 ? ", or their stated standard deviation is too small" : ""));
  return lines;
}

nlohmann::ordered_json positions_json(const pose::RefineReport& report) {
  if (report.positions.empty()) return nullptr;
  const pose::PositionDistances& found = report.position_distances;
  nlohmann::ordered_json json{{"count", found.count}, {"rms_m", found.rms}};
  if (const double sigma = estimated_sigma(report); sigma > 0) json["estimated_sigma_m"] = sigma;
  if (found.of_stated > 0) json["of_stated_sigma"] = found.of_stated;
  return json;
}

}  // namespace axial::apps
