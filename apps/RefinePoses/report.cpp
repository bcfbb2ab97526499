// SPDX-License-Identifier: GPL-3.0-or-later
#include "report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/json.h"
#include "pose/free_numbers.h"

namespace {

using namespace axial;
using pose::Bundle;

std::vector<std::vector<double>> errors_of_images(const Bundle& bundle) {
  std::vector<std::vector<double>> errors(bundle.images.size());
  const std::vector<double> all = reprojection_errors(bundle);
  for (std::size_t i = 0; i < all.size(); ++i)
    errors[bundle.observations[i].image].push_back(all[i]);
  return errors;
}

}  // namespace

std::vector<ImageErrors> errors_by_image(const Bundle& before, const Bundle& after) {
  const auto first = errors_of_images(before), last = errors_of_images(after);
  std::vector<ImageErrors> rows;
  for (std::size_t i = 0; i < first.size(); ++i)
    rows.push_back({before.images[i].name, last[i].size(), pose::root_mean_square(first[i]),
                    pose::root_mean_square(last[i])});
  return rows;
}

std::vector<std::string> report_lines(const pose::RefineReport& report,
                                      std::span<const ImageErrors> images, const Bundle& bundle,
                                      std::span<const std::string> ports,
                                      const pose::AdjustOptions& options) {
  std::vector<std::string> lines;
  lines.push_back(fmt::format("{:<32} {:>12} {:>11} {:>11}", "image", "observations", "before [px]",
                              "after [px]"));
  for (const ImageErrors& image : images)
    lines.push_back(fmt::format("{:<32} {:>12} {:>11.3f} {:>11.3f}", image.name, image.observations,
                                image.rms_before, image.rms_after));
  lines.push_back(fmt::format("{:<32} {:>12} {:>11.3f} {:>11.3f}", "all", report.observations_after,
                              report.rms_before, report.rms_after));
  for (std::size_t i = 0; i < bundle.cameras.size(); ++i)
    for (const pose::FreeValue& value :
         pose::free_values(bundle.cameras[i], report.uncertainty.camera_sigmas[i], options))
      lines.push_back(fmt::format("Camera {} behind {}: {} {:.6g} +- {:.2g} {}", i + 1, ports[i],
                                  value.name, value.now, value.sigma, value.unit));
  if (!options.poses_known)
    lines.push_back(fmt::format("All lengths are known to {:.3g} % (one standard deviation)",
                                report.uncertainty.scale_sigma * 100));
  return lines;
}

std::string report_json(const pose::RefineReport& report, std::span<const ImageErrors> images,
                        const Bundle& bundle, std::span<const std::string> ports,
                        const pose::AdjustOptions& options) {
  using Json = nlohmann::ordered_json;
  Json json{{"rms_before_px", report.rms_before},
            {"rms_after_px", report.rms_after},
            {"pixel_sigma", report.uncertainty.pixel_sigma},
            {"converged", report.last.converged},
            {"observations_before", report.observations_before},
            {"observations_after", report.observations_after},
            {"points_before", report.points_before},
            {"points_after", report.points_after}};
  // JSON has no infinity: null says that nothing tells the scale.
  json["scale_sigma"] = std::isfinite(report.uncertainty.scale_sigma)
                            ? Json(report.uncertainty.scale_sigma)
                            : Json(nullptr);
  for (const ImageErrors& image : images)
    json["images"].push_back({{"name", image.name},
                              {"observations", image.observations},
                              {"rms_before_px", image.rms_before},
                              {"rms_after_px", image.rms_after}});
  for (std::size_t i = 0; i < bundle.cameras.size(); ++i) {
    Json camera{{"id", i + 1}, {"port", ports[i]}, {"free", Json::array()}};
    for (const pose::FreeValue& value :
         pose::free_values(bundle.cameras[i], report.uncertainty.camera_sigmas[i], options))
      camera["free"].push_back({{"name", value.name},
                                {"unit", value.unit},
                                {"value", value.now},
                                {"sigma", value.sigma}});
    json["cameras"].push_back(camera);
  }
  // Names in another encoding than UTF-8 are not worth the loss of the report.
  return io::to_text(json, 1) + "\n";
}
