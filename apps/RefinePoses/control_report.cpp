// SPDX-License-Identifier: GPL-3.0-or-later
#include "control_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "pose/adjust/uncertainty.h"

namespace axial::apps {
namespace {

using Json = nlohmann::ordered_json;
using Between = pose::KnownDistance::Between;

constexpr double kDoubtful = 3;  // standard deviations

// The photographs that observe a point.
std::set<std::size_t> photographs_of(const pose::Bundle& bundle, std::size_t source) {
  std::set<std::size_t> images;
  for (const pose::Observation& one : bundle.observations)
    if (bundle.points[one.point].source == source) images.insert(one.image);
  return images;
}

std::size_t photographs_of(const pose::Bundle& bundle, const pose::KnownPlace& place) {
  return place.of == Between::images ? 1 : photographs_of(bundle, place.index).size();
}

std::size_t photographs_of_both(const pose::Bundle& bundle, const pose::KnownDistance& bar) {
  const std::set<std::size_t> first = photographs_of(bundle, bar.first);
  const std::set<std::size_t> second = photographs_of(bundle, bar.second);
  return static_cast<std::size_t>(
      std::ranges::count_if(first, [&](std::size_t image) { return second.contains(image); }));
}

// The fit with known and found coordinates in the world.
pose::PlaceFit in_world(pose::PlaceFit fit, const LocalFrame& frame) {
  for (std::size_t k = 0; k < 3; ++k) {
    const double origin = frame.origin(static_cast<Eigen::Index>(k));
    fit.coordinates[k].known += origin;
    fit.coordinates[k].present += origin;
  }
  return fit;
}

void add(const pose::Bundle& bundle, const pose::AdjustOptions& options, const LocalFrame& frame,
         const std::vector<pose::KnownDistance>& distances,
         const std::vector<pose::KnownPlace>& places, bool check, ControlResults& results) {
  const pose::ControlFits fits = pose::control_fits(bundle, options, distances, places, !check);
  for (std::size_t i = 0; i < distances.size(); ++i)
    if (!distances[i].name.empty())
      results.bars.push_back(
          {distances[i].name, fits.distances[i], photographs_of_both(bundle, distances[i]), check});
  for (std::size_t i = 0; i < places.size(); ++i)
    results.points.push_back({places[i].name, in_world(fits.places[i], frame),
                              photographs_of(bundle, places[i]), check});
}

void count_targets(const pose::Bundle& bundle, ControlResults& results) {
  const std::vector<double> errors = reprojection_errors(bundle);
  std::vector<double> of_targets;
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (bundle.points[bundle.observations[i].point].is_target) of_targets.push_back(errors[i]);
  results.observations = of_targets.size();
  results.rms = pose::root_mean_square(of_targets);
  results.targets = static_cast<std::size_t>(
      std::ranges::count(bundle.points, true, &pose::BundlePoint::is_target));
}

const char* use_of(bool check) {
  return check ? "check" : "used";
}

std::string off_in_words(const pose::KnownFit& fit) {
  if (!std::isfinite(fit.expected)) return "not determined";
  return fmt::format("{:+.2f} mm ({:.2f})", 1000 * fit.off(), 1000 * fit.expected);
}

Json json_of(const pose::KnownFit& fit) {
  if (!std::isfinite(fit.known_sigma)) return nullptr;
  Json json{{"stated", fit.known}, {"stated_sigma", fit.known_sigma}, {"found", fit.present}};
  json["found_sigma"] = std::isfinite(fit.present_sigma) ? Json(fit.present_sigma) : Json(nullptr);
  json["residual"] = std::isfinite(fit.expected) ? Json(fit.off()) : Json(nullptr);
  json["expected_sigma"] = std::isfinite(fit.expected) ? Json(fit.expected) : Json(nullptr);
  return json;
}

bool is_doubtful(const pose::KnownFit& fit) {
  return std::isfinite(fit.known_sigma) && std::abs(fit.deviation()) > kDoubtful;
}

std::string doubt(bool check, const std::string& name, const pose::KnownFit& fit) {
  return fmt::format("{} {} is off by {:.3g} mm, {:.2g} standard deviations",
                     check ? "The check" : "The used value of", name, 1000 * fit.off(),
                     std::abs(fit.deviation()));
}

}  // namespace

ControlResults control_results(const pose::Bundle& bundle, const pose::AdjustOptions& options,
                               const LocalFrame& frame, ControlChecks checks,
                               std::vector<std::string> left_out) {
  ControlResults results;
  results.left_out = std::move(left_out);
  count_targets(bundle, results);
  add(bundle, options, frame, options.distances, options.places, false, results);
  pose::AdjustOptions of_checks;
  of_checks.distances = std::move(checks.distances);
  of_checks.places = std::move(checks.places);
  for (std::string& line : pose::leave_out_lost(bundle, of_checks))
    results.left_out.push_back(std::move(line));
  add(bundle, options, frame, of_checks.distances, of_checks.places, true, results);
  return results;
}

std::vector<std::string> control_lines(const ControlResults& results) {
  std::vector<std::string> lines{fmt::format("{} targets, {} observations, RMS {:.3f} px",
                                             results.targets, results.observations, results.rms)};
  if (!results.bars.empty())
    lines.push_back("Bars: found minus stated (expected standard deviation), photographs:");
  for (const BarResult& bar : results.bars)
    lines.push_back(fmt::format("  {}: {}, {}, {}", bar.name, off_in_words(bar.fit),
                                bar.photographs, use_of(bar.check)));
  if (!results.points.empty())
    lines.push_back(
        "Control points: found minus stated in x, y, z (expected standard deviation), "
        "photographs:");
  for (const PointResult& point : results.points) {
    std::vector<std::string> words;
    for (const pose::KnownFit& fit : point.fit.coordinates)
      words.push_back(std::isfinite(fit.known_sigma) ? off_in_words(fit) : "-");
    lines.push_back(fmt::format("  {}: {}, {}, {}", point.name, fmt::join(words, ", "),
                                point.photographs, use_of(point.check)));
  }
  return lines;
}

std::vector<std::string> control_warnings(const ControlResults& results) {
  std::vector<std::string> lines = results.left_out;
  for (const BarResult& bar : results.bars)
    if (is_doubtful(bar.fit)) lines.push_back(doubt(bar.check, bar.name, bar.fit));
  for (const PointResult& point : results.points)
    for (std::size_t k = 0; k < 3; ++k)
      if (is_doubtful(point.fit.coordinates[k]))
        lines.push_back(doubt(point.check, point.name + " in " + std::string("xyz")[k],
                              point.fit.coordinates[k]));
  return lines;
}

nlohmann::ordered_json control_json(const ControlResults& results) {
  Json json{{"targets", results.targets},   {"observations", results.observations},
            {"rms_px", results.rms},        {"crs", results.crs},
            {"bars", Json::array()},        {"points", Json::array()},
            {"left_out", results.left_out}, {"map_scale", results.map_scale}};
  for (const BarResult& bar : results.bars)
    json["bars"].push_back({{"name", bar.name},
                            {"use", use_of(bar.check)},
                            {"photographs", bar.photographs},
                            {"length_m", json_of(bar.fit)}});
  for (const PointResult& point : results.points)
    json["points"].push_back({{"name", point.name},
                              {"use", use_of(point.check)},
                              {"photographs", point.photographs},
                              {"x_m", json_of(point.fit.coordinates[0])},
                              {"y_m", json_of(point.fit.coordinates[1])},
                              {"z_m", json_of(point.fit.coordinates[2])}});
  return json;
}

control::TargetPlaces target_places(const pose::Bundle& bundle, const pose::AdjustOptions& options,
                                    const std::vector<pose::Target>& targets,
                                    const LocalFrame& frame) {
  std::vector<pose::PlaceIndex> indices;
  control::TargetPlaces places;
  for (const pose::Target& target : targets) {
    const auto point = std::ranges::find(bundle.points, target.source, &pose::BundlePoint::source);
    if (target.source == 0 || point == bundle.points.end()) continue;
    indices.push_back({Between::points, target.source});
    places.targets.push_back({target.label, frame.to_world(point->position),
                              photographs_of(bundle, target.source).size()});
  }
  if (!indices.empty()) places.covariance = pose::covariance_of_places(bundle, options, indices);
  return places;
}

}  // namespace axial::apps
