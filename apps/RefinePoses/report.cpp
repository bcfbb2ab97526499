// SPDX-License-Identifier: GPL-3.0-or-later
#include "report.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "io/bytes/json.h"
#include "pose/free_numbers.h"
#include "position_lines.h"

namespace axial::apps {
namespace {

using pose::Bundle;

std::string doubt(double sigma) {
  return std::isfinite(sigma) ? fmt::format(" +- {:.2g}", sigma) : " (not known)";
}

// A number with its standard deviation and its unit.
std::string in_words(double value, const std::string& doubt, const std::string& unit) {
  return fmt::format("{:.6g}{}{}{}", value, doubt, unit.empty() ? "" : " ", unit);
}

// The value, its stated value, and what decided.
std::string in_words(const pose::FreeValue& value) {
  const std::string found = value.name + " " + in_words(value.now, doubt(value.sigma), value.unit);
  if (!(value.sigma_before > 0))
    return fmt::format("{}, before: {}", found, in_words(value.before, "", value.unit));
  return fmt::format("{}, stated: {}, decided by the {}", found,
                     in_words(value.before, doubt(value.sigma_before), value.unit),
                     value.by_photographs() ? "photographs" : "stated value");
}

double scale_sigma(const Results& results, double sigma) {
  return results.scale_lost ? std::numeric_limits<double>::infinity() : sigma;
}

// JSON has no infinity: null means that nothing determines the number.
nlohmann::ordered_json finite_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

// null: not measured.
nlohmann::ordered_json positive_or_null(double value) {
  return value > 0 ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

// What decided about a value; null before standard deviations are computed.
nlohmann::ordered_json decided_by(const pose::FreeValue& value, bool computed) {
  if (!computed) return nullptr;
  return value.by_photographs() ? "photographs" : "stated value";
}

nlohmann::ordered_json json_of(const Registered& registered) {
  using Json = nlohmann::ordered_json;
  Json json{{"photographs", registered.names},
            {"left_out", Json::array()},
            {"observations", registered.observations},
            {"points", registered.points}};
  for (const Unregistered& one : registered.left_out)
    json["left_out"].push_back({{"name", one.name}, {"reason", one.reason}});
  return json;
}

// The uncertainty before standard deviations are computed: only the noise is known.
pose::Uncertainty not_computed(const Results& results) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  pose::Uncertainty none;
  none.pixel_sigma = pose::observed_pixel_sigma(results.bundle, results.options);
  none.camera_sigmas.assign(results.bundle.cameras.size(),
                            pose::HousingChange<double>::Constant(kInfinite));
  none.scale_sigma = results.options.poses_known ? 0 : kInfinite;
  return none;
}

}  // namespace

std::vector<ImageErrors> errors_by_image(const Bundle& before, const Bundle& after) {
  const auto first = pose::reprojection_errors_by_image(before);
  const auto last = pose::reprojection_errors_by_image(after);
  std::vector<ImageErrors> rows;
  for (std::size_t i = 0; i < first.size(); ++i)
    rows.push_back({before.images[i].name, last[i].size(), pose::root_mean_square(first[i]),
                    pose::root_mean_square(last[i])});
  return rows;
}

std::vector<std::string> error_lines(const Results& results) {
  const pose::RefineReport& report = results.report;
  std::vector<std::string> lines;
  lines.push_back(fmt::format("{:<32} {:>12} {:>11} {:>11}", "image", "observations", "before [px]",
                              "after [px]"));
  for (const ImageErrors& image : results.images)
    lines.push_back(fmt::format("{:<32} {:>12} {:>11.3f} {:>11.3f}", image.name, image.observations,
                                image.rms_before, image.rms_after));
  lines.push_back(fmt::format("{:<32} {:>12} {:>11.3f} {:>11.3f}", "all", report.observations_after,
                              report.rms_before, report.rms_after));
  return lines;
}

std::vector<std::string> uncertainty_lines(const Results& results, const pose::Uncertainty& known) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < results.bundle.cameras.size(); ++i)
    for (const pose::FreeValue& value :
         pose::free_values(results.bundle.cameras[i], known.camera_sigmas[i], results.options))
      lines.push_back(
          fmt::format("Camera {} behind {}: {}", i + 1, results.ports[i], in_words(value)));
  if (results.options.poses_known) return lines;
  const double scale = scale_sigma(results, known.scale_sigma);
  lines.push_back(
      std::isfinite(scale)
          ? fmt::format("All lengths are known to {:.3g} % (one standard deviation)", scale * 100)
          : "All lengths are unknown: the model has no scale");
  return lines;
}

std::optional<std::string> scale_warning(const Results& results, const pose::Uncertainty& known) {
  constexpr double kLargest = 0.02;
  const pose::AdjustOptions& options = results.options;
  if (options.poses_known || results.scale_lost || !options.distances.empty() ||
      !options.positions.empty() || known.scale_sigma <= kLargest)
    return {};
  const std::string known_to =
      std::isfinite(known.scale_sigma)
          ? fmt::format("known only to {:.2g} % (one standard deviation)", 100 * known.scale_sigma)
          : std::string("not known");
  return fmt::format(
      "All lengths are {}, because only refraction determines the scale: state a known length or "
      "positions with --scale-from, or measure the port",
      known_to);
}

std::string report_json(const Results& results, const pose::Uncertainty* known) {
  using Json = nlohmann::ordered_json;
  const pose::RefineReport& report = results.report;
  const pose::Uncertainty uncertainty = known ? *known : not_computed(results);
  Json json{{"rms_before_px", report.rms_before},
            {"rms_after_px", report.rms_after},
            {"pixel_sigma", uncertainty.pixel_sigma},
            {"converged", report.last.converged},
            {"observations_before", report.observations_before},
            {"observations_after", report.observations_after},
            {"points_before", report.points_before},
            {"points_after", report.points_after}};
  json["scale_sigma"] = finite_or_null(scale_sigma(results, uncertainty.scale_sigma));
  if (!known) json["standard_deviations"] = "missing";
  if (Json positions = positions_json(report); !positions.is_null())
    json["positions"] = std::move(positions);
  if (!results.unused.empty()) json["unused"] = results.unused;
  if (results.registered) json["registered"] = json_of(*results.registered);
  for (const ImageErrors& image : results.images)
    json["images"].push_back({{"name", image.name},
                              {"observations", image.observations},
                              {"rms_before_px", image.rms_before},
                              {"rms_after_px", image.rms_after}});
  for (std::size_t i = 0; i < results.bundle.cameras.size(); ++i) {
    Json camera{{"id", i + 1}, {"port", results.ports[i]}, {"free", Json::array()}};
    for (const pose::FreeValue& value : pose::free_values(
             results.bundle.cameras[i], uncertainty.camera_sigmas[i], results.options))
      camera["free"].push_back({{"name", value.name},
                                {"unit", value.unit},
                                {"value", value.now},
                                {"sigma", finite_or_null(value.sigma)},
                                {"before", value.before},
                                {"sigma_before", positive_or_null(value.sigma_before)},
                                {"decided_by", decided_by(value, known != nullptr)}});
    json["cameras"].push_back(camera);
  }
  // to_text() replaces bytes that are not UTF-8: such a name must not prevent the report.
  return io::to_text(json, 1) + "\n";
}

}  // namespace axial::apps
