// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud_parts.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "evaluate/report.h"
#include "io/ply/ply.h"

namespace axial::apps {
namespace {

using Json = nlohmann::ordered_json;

template <class Class>
Json told(const std::vector<Class>& classes, const std::vector<double>& tolerances) {
  const std::span<const Class> all(classes);
  fmt::print("{}", evaluate::table(all, tolerances));
  return evaluate::to_json(all);
}

template <class Part>
Json told(const Part& part) {
  fmt::print("{}", evaluate::table(part));
  return evaluate::to_json(part);
}

}  // namespace

evaluate::PointUncertainty read_uncertainty(const std::filesystem::path& path,
                                            const PointCloud& cloud) {
  evaluate::PointUncertainty uncertainty;
  uncertainty.error = io::read_vertex_property(path, "error");
  uncertainty.confidence = io::read_vertex_property(path, "confidence");
  if (!cloud.view_begin.empty())
    for (std::size_t i = 0; i < cloud.size(); ++i)
      uncertainty.views.push_back(static_cast<std::uint32_t>(cloud.views_of(i).size()));
  return uncertainty;
}

Json report_parts(const Options& options, const Evaluated& e) {
  Json report = Json::object();
  if (!e.views.empty()) {
    const std::vector<float> thickness = io::read_vertex_property(options.truth, "thickness");
    if (!thickness.empty())
      report["by_thickness"] = told(
          evaluate::recall_by_thickness(e.whole.places, e.whole.place_distances, options.tolerances,
                                        e.truth, e.surface, thickness, e.views),
          options.tolerances);
  }
  if (!e.uncertainty.views.empty())
    report["points_by_views"] =
        told(evaluate::errors_by_views(e.uncertainty.views, e.whole.distances, options.tolerances,
                                       e.whole.gross),
             options.tolerances);
  if (const auto calibration = evaluate::calibration_of(e.uncertainty, e.whole.distances))
    report["calibration"] = told(*calibration);
  if (options.strip)
    report["strip"] = told(evaluate::density_along_strip(e.points, e.whole.places, e.views));
  return report;
}

}  // namespace axial::apps
