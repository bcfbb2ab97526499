// SPDX-License-Identifier: GPL-3.0-or-later
#include "report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace {

using namespace axial;
using pose::Bundle;
using pose::BundleCamera;

std::vector<std::vector<double>> errors_of_images(const Bundle& bundle) {
  std::vector<std::vector<double>> errors(bundle.images.size());
  const std::vector<double> all = reprojection_errors(bundle);
  for (std::size_t i = 0; i < all.size(); ++i)
    errors[bundle.observations[i].image].push_back(all[i]);
  return errors;
}

// One number of a camera as people know it.
struct Value {
  std::string name, unit;
  double now, sigma;
};

constexpr double kDegrees = 180 / std::numbers::pi;

struct ValuesOfPort {
  const pose::HousingChange<double>& sigmas;

  std::vector<Value> operator()(const refractive::FlatPort<double>& port) const {
    const double tilt_x = std::atan2(port.normal.x(), port.normal.z()) * kDegrees;
    const double tilt_y = std::atan2(port.normal.y(), port.normal.z()) * kDegrees;
    return {{"normal to the right", "degrees", tilt_x, sigmas(0) * kDegrees},
            {"normal downwards", "degrees", tilt_y, sigmas(1) * kDegrees},
            {"distance", "mm", port.distance * 1e3, sigmas(2) * 1e3},
            {"index of water", "", port.n_water, sigmas(3)}};
  }
  std::vector<Value> operator()(const refractive::DomePort<double>& port) const {
    return {{"centre x", "mm", port.centre.x() * 1e3, sigmas(0) * 1e3},
            {"centre y", "mm", port.centre.y() * 1e3, sigmas(1) * 1e3},
            {"centre z", "mm", port.centre.z() * 1e3, sigmas(2) * 1e3},
            {"index of water", "", port.n_water, sigmas(3)}};
  }
};

// Those under adjustment.
std::vector<Value> free_values(const BundleCamera& camera,
                               const pose::HousingChange<double>& sigmas,
                               const pose::AdjustOptions& options) {
  const CameraModel now = camera.now();
  std::vector<Value> all(pose::kFocalNumber);
  if (now.port) all = std::visit(ValuesOfPort{sigmas}, *now.port);
  const double factor = std::exp(camera.change(pose::kFocalNumber));
  all.push_back({"focal length, factor", "", factor, sigmas(pose::kFocalNumber) * factor});
  std::vector<Value> chosen;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (options.free[k]) chosen.push_back(all[k]);
  return chosen;
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
    for (const Value& value :
         free_values(bundle.cameras[i], report.uncertainty.camera_sigmas[i], options))
      lines.push_back(fmt::format("Camera {} behind {}: {} {:.6g} +- {:.2g} {}", i + 1, ports[i],
                                  value.name, value.now, value.sigma, value.unit));
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
    for (const Value& value :
         free_values(bundle.cameras[i], report.uncertainty.camera_sigmas[i], options))
      camera["free"].push_back({{"name", value.name},
                                {"unit", value.unit},
                                {"value", value.now},
                                {"sigma", value.sigma}});
    json["cameras"].push_back(camera);
  }
  // Names in another encoding than UTF-8 are not worth the loss of the report.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}
