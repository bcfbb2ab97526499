// SPDX-License-Identifier: GPL-3.0-or-later
#include "report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "io/bytes/json.h"
#include "pose/adjust/free_numbers.h"
#include "pose/adjust/uncertainty.h"
#include "rigs.h"

namespace axial::apps {
namespace {

using Json = nlohmann::ordered_json;
using pose::Bundle;

// Without positions that pull, adjustment cannot make the reprojection errors this much larger.
constexpr double kLargerErrors = 1.1;

// The estimated standard deviation [m]; 0 if all were stated.
double estimated_sigma(const pose::RefineReport& report) {
  const auto guess =
      std::ranges::find(report.positions, true, &pose::KnownPosition::sigma_is_guess);
  return guess == report.positions.end() ? 0 : guess->sigma.x();
}

std::string doubt(double sigma) {
  return std::isfinite(sigma) ? fmt::format(" +- {:.2g}", sigma) : " (not known)";
}

// A number with its standard deviation and its unit.
std::string in_words(double value, const std::string& doubt, const std::string& unit) {
  return fmt::format("{:.6g}{}{}{}", value, doubt, unit.empty() ? "" : " ", unit);
}

// The value, its stated value, and what decided.
std::string in_words(const pose::HousingNumber& value) {
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

// Uncertainty::shape_sigma, for sentences about the shape of the model.
std::string shape_in_words(const pose::Uncertainty& known) {
  if (!std::isfinite(known.shape_sigma)) return "unknown";
  return fmt::format(
      "known to {:.2g} % of the distance of the points (one standard deviation of the cameras' "
      "centres relative to each other)",
      100 * known.shape_sigma);
}

// The largest distance between the first camera and another camera.
double length_of(const Bundle& bundle) {
  double length = 0;
  for (const pose::BundleImage& image : bundle.images)
    length = std::max(length, (image.pose.centre - bundle.images.front().pose.centre).norm());
  return length;
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
nlohmann::ordered_json decided_by(const pose::HousingNumber& value, bool computed) {
  if (!computed) return nullptr;
  return value.by_photographs() ? "photographs" : "stated value";
}

nlohmann::ordered_json json_of(const Registered& registered) {
  Json json{{"photographs", registered.names},
            {"left_out", Json::array()},
            {"observations", registered.observations},
            {"points", registered.points}};
  for (const Unregistered& one : registered.left_out)
    json["left_out"].push_back({{"name", one.name}, {"reason", one.reason}});
  return json;
}

// The object "positions" of the report. Null if no position was used.
nlohmann::ordered_json positions_json(const pose::RefineReport& report) {
  if (report.positions.empty()) return nullptr;
  const pose::PositionDistances& found = report.position_distances;
  nlohmann::ordered_json json{{"count", found.count}, {"rms_m", found.rms}};
  if (const double sigma = estimated_sigma(report); sigma > 0) json["estimated_sigma_m"] = sigma;
  if (found.of_stated > 0) json["of_stated_sigma"] = found.of_stated;
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
  none.shape_sigma = none.scale_sigma;
  none.depth_sigma = none.scale_sigma;
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

std::vector<std::string> uncertainty_lines(const Results& results, const pose::Uncertainty& known) {
  std::vector<std::string> lines;
  for (const pose::HousingNumber& value :
       pose::free_values(results.bundle, known.camera_sigmas, results.options))
    lines.push_back(fmt::format("Camera {} behind {}: {}", value.camera + 1,
                                results.ports[value.camera], in_words(value)));
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
  if (options.poses_known || results.scale_lost || options.know_lengths() ||
      known.scale_sigma <= kLargest)
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

std::string shape_line(const pose::Uncertainty& known) {
  return fmt::format("The shape of the model is {}", shape_in_words(known));
}

std::optional<std::string> shape_warning(const Results& results, const pose::Uncertainty& known) {
  constexpr double kLargest = 0.002, kLargestOfLength = 1.0 / 2000;
  const double sigma = known.shape_sigma * pose::median_distance(results.bundle);
  if (known.shape_sigma <= kLargest || sigma <= kLargestOfLength * length_of(results.bundle))
    return {};
  return fmt::format(
      "{}, and least at {}: too few points link the photographs, so that the model can be bent. "
      "Take photographs that overlap by 60 % or more along strips, or strips that cross, or state "
      "positions with --scale-from",
      shape_line(known), results.bundle.images[known.least_linked].name);
}

std::string depth_line(const pose::Uncertainty& known) {
  if (!std::isfinite(known.depth_sigma))
    return "The distances of the points from the cameras are not known";
  return fmt::format(
      "The distances of the points from the cameras are known to {:.2g} % (one standard deviation, "
      "from the numbers of lens and port)",
      100 * known.depth_sigma);
}

std::optional<std::string> depth_warning(const pose::Uncertainty& known) {
  constexpr double kLargest = 0.003;  // three of them: 1 % of the distance
  if (known.depth_sigma <= kLargest) return {};
  return depth_line(known) +
         ": calibrate the lens in air and the port with CalibrateHousing, or take photographs at "
         "several distances and turned by 90 degrees";
}

std::string report_json(const Results& results, const pose::Uncertainty* known) {
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
  json["shape_sigma"] = finite_or_null(uncertainty.shape_sigma);
  json["depth_sigma"] = finite_or_null(uncertainty.depth_sigma);
  if (!known) json["standard_deviations"] = "missing";
  if (Json positions = positions_json(report); !positions.is_null())
    json["positions"] = std::move(positions);
  if (Json rigs = rigs_json(results.bundle, uncertainty); !rigs.is_null())
    json["rigs"] = std::move(rigs);
  if (!results.unused.empty()) json["unused"] = results.unused;
  if (results.control) json["control"] = control_json(*results.control);
  if (results.registered) json["registered"] = json_of(*results.registered);
  for (const ImageErrors& image : results.images)
    json["images"].push_back({{"name", image.name},
                              {"observations", image.observations},
                              {"rms_before_px", image.rms_before},
                              {"rms_after_px", image.rms_after}});
  for (std::size_t i = 0; i < results.bundle.cameras.size(); ++i)
    json["cameras"].push_back({{"id", i + 1}, {"port", results.ports[i]}, {"free", Json::array()}});
  for (const pose::HousingNumber& value :
       pose::free_values(results.bundle, uncertainty.camera_sigmas, results.options))
    json["cameras"][value.camera]["free"].push_back(
        {{"name", value.name},
         {"unit", value.unit},
         {"value", value.now},
         {"sigma", finite_or_null(value.sigma)},
         {"before", value.before},
         {"sigma_before", positive_or_null(value.sigma_before)},
         {"decided_by", decided_by(value, known != nullptr)}});
  // to_text() replaces bytes that are not UTF-8: such a name must not prevent the report.
  return io::to_text(json, 1) + "\n";
}

}  // namespace axial::apps
