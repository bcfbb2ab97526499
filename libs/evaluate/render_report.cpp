// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "evaluate/report.h"

namespace axial::evaluate {
namespace {

using Json = nlohmann::ordered_json;

PictureDifference together(std::span<const ViewReport> views) {
  PictureDifference all;
  for (const ViewReport& view : views)
    if (view.difference) all += *view.difference;
  return all;
}

void add(Json& report, const PictureDifference& difference) {
  const double psnr = difference.psnr();
  report["psnr"] = std::isfinite(psnr) ? Json(psnr) : Json();
  report["mean_difference"] = difference.mean();
}

Json view_json(const ViewReport& view) {
  Json report{{"view", view.view}, {"pictures", view.pictures}, {"covered", view.covered}};
  if (view.truth_covered) report["truth_covered"] = *view.truth_covered;
  if (!view.difference) return report;
  report["photograph"] = view.photograph;
  report["compared"] = view.compared;
  add(report, *view.difference);
  return report;
}

std::string row(const std::string& name, const std::string& covered, const std::string& compared,
                const std::optional<PictureDifference>& difference) {
  return fmt::format("{:<22}{:>10}{:>10}", name, covered, compared) +
         (difference && difference->pixels > 0
              ? fmt::format("{:>10.2f}{:>12.2f}\n", difference->psnr(), difference->mean())
              : fmt::format("{:>10}{:>12}\n", "-", "-"));
}

}  // namespace

Json to_json(std::span<const ViewReport> views) {
  Json report{{"views", Json::array()}};
  for (const ViewReport& view : views) report["views"].push_back(view_json(view));
  if (std::ranges::any_of(views, [](const ViewReport& v) { return v.difference.has_value(); }))
    add(report, together(views));
  return report;
}

std::string table(std::span<const ViewReport> views) {
  std::string text = fmt::format("{:<22}{:>10}{:>10}{:>10}{:>12}\n", "rendered view", "covered",
                                 "compared", "PSNR [dB]", "mean error");
  for (const ViewReport& view : views)
    text += row(view.view, fmt::format("{:.4f}", view.covered),
                view.difference ? fmt::format("{:.4f}", view.compared) : "-", view.difference);
  const auto photographs = std::ranges::count_if(
      views, [](const ViewReport& view) { return view.difference.has_value(); });
  if (photographs > 1) text += row("all views", "", "", together(views));
  return text;
}

}  // namespace axial::evaluate
