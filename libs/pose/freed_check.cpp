// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/freed_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "pose/free_numbers.h"
#include "pose/track_sample.h"

namespace axial::pose {
namespace {

constexpr SampleLimits kLimits{600, 40, 40, 1};
constexpr double kLeastDrop = 0.07;
constexpr double kLeastGain = 0.02;  // [px]
constexpr double kLeastDeviations = 6;

AdjustOptions options_for(const Bundle& part, const AdjustOptions& options) {
  AdjustOptions result;
  result.poses_known = options.poses_known;
  result.pixel_sigma = std::max(1e-3, observed_pixel_sigma(part, result));
  result.loss_sigmas = 4;
  result.max_iterations = 20;
  if (options.poses_known) return result;
  // Holds the length from the first image to the image farthest from it.
  std::size_t farthest = 0;
  const auto length = [&](std::size_t i) {
    return (part.images[i].pose.centre - part.images[0].pose.centre).norm();
  };
  for (std::size_t i = 1; i < part.images.size(); ++i)
    if (length(i) > length(farthest)) farthest = i;
  if (farthest > 0)
    result.distances.push_back(
        {KnownDistance::Between::images, 0, farthest, length(farthest), 1e-4 * length(farthest)});
  return result;
}

double adjusted_rms(Bundle& part, const AdjustOptions& options) {
  adjust(part, options);
  return root_mean_square(reprojection_errors(part));
}

// Numbers that can be wrong alone. The numbers of a normal or of a centre are one group.
std::vector<std::vector<std::size_t>> candidates(const Bundle& part) {
  const auto& port = part.cameras.front().measured.port;
  std::vector<std::vector<std::size_t>> groups{{kIndexNumber}};
  if (std::holds_alternative<refractive::FlatPort<double>>(*port))
    groups.insert(groups.end(), {{0, 1}, {2}});
  else
    groups.push_back({0, 1, 2});
  groups.push_back({kFocalNumber});
  return groups;
}

// Whether all ports are flat or all are domes: their numbers have different meanings.
bool of_one_kind(const Bundle& part) {
  return std::ranges::all_of(part.cameras, [&](const BundleCamera& camera) {
    return camera.measured.port &&
           camera.measured.port->index() == part.cameras.front().measured.port->index();
  });
}

// The number of the first camera that changed most.
FreedNumber moved_most(const Bundle& before, const Bundle& after, const AdjustOptions& options) {
  const HousingChange<double> none = HousingChange<double>::Zero();
  const auto stated = free_values(before.cameras.front(), none, options);
  const auto found = free_values(after.cameras.front(), none, options);
  FreedNumber freed;
  for (std::size_t i = 0; i < stated.size(); ++i)
    if (freed.name.empty() ||
        std::abs(found[i].now - stated[i].now) > std::abs(freed.found - freed.stated)) {
      freed.name = stated[i].name;
      freed.unit = stated[i].unit;
      freed.stated = stated[i].now;
      freed.found = found[i].now;
    }
  return freed;
}

}  // namespace

std::optional<FreedNumber> number_that_does_not_fit(const Bundle& refined,
                                                    const AdjustOptions& options) {
  Bundle part = sample_bundle(refined, kLimits, true);
  if (part.images.size() < 3 || part.points.size() < 20 || !of_one_kind(part)) return {};
  std::optional<FreedNumber> best;
  try {
    const AdjustOptions held = options_for(part, options);
    const double stated = adjusted_rms(part, held);
    for (const auto& group : candidates(part)) {
      if (std::ranges::any_of(
              group, [&](std::size_t k) { return options.unknowns(part.cameras.front()).free[k]; }))
        continue;
      AdjustOptions freeing = held;
      for (const std::size_t number : group) freeing.free[number] = true;
      Bundle trial = part;
      const double found = adjusted_rms(trial, freeing);
      if (found > (1 - kLeastDrop) * stated || found > stated - kLeastGain ||
          (best && found >= best->rms_found))
        continue;
      const double sigma = observed_pixel_sigma(trial, freeing);
      const auto n = static_cast<double>(part.observations.size());
      FreedNumber freed = moved_most(part, trial, freeing);
      freed.rms_stated = stated;
      freed.rms_found = found;
      freed.deviations = std::sqrt(n * (stated * stated - found * found)) / sigma;
      if (freed.deviations > kLeastDeviations) best = freed;
    }
  } catch (const Error&) {
    return {};  // an adjustment fails where a number leaves its valid range
  }
  return best;
}

std::string warning_of(const FreedNumber& freed, double scale_sigma, SettingNames name_of) {
  const auto value = [&](double number) {
    return fmt::format("{:.4g}{}{}", number, freed.unit.empty() ? "" : " ", freed.unit);
  };
  const std::string deviations = freed.deviations < 100 ? fmt::format("{:.0f}", freed.deviations)
                                                        : std::string("more than 100");
  const std::string lengths =
      std::isfinite(scale_sigma) && scale_sigma > 0
          ? fmt::format("The lengths then have a larger error than {:.2g} %. ", 100 * scale_sigma)
          : std::string();
  return fmt::format(
      "Lens, port and scale do not fit the photographs: with {} at {} (given: {}, {} standard "
      "deviations away), errors are {:.3f} px instead of {:.3f} px (RMS). {}Measure this value "
      "again, or adjust it with {}",
      freed.name, value(freed.found), value(freed.stated), deviations, freed.rms_found,
      freed.rms_stated, lengths, name_of("refine"));
}

std::vector<std::string> dropped_lines(const RefineReport& report, const TrackLimits& limits) {
  const std::size_t distinct = report.observations_before - report.repeated;
  const auto many = [&](std::size_t count) { return 4 * count > distinct; };
  const DropCounts& dropped = report.dropped;
  std::vector<std::string> lines;
  if (many(dropped.errors))
    lines.push_back(
        fmt::format("{} of {} observations have errors above {:.3g} px and are dropped: check the "
                    "housing and the lens in air",
                    dropped.errors, distinct, limits.max_error));
  if (many(dropped.weak_images))
    lines.push_back(
        fmt::format("{} of {} observations belong to images with fewer than {} observations that "
                    "fit, and are left out",
                    dropped.weak_images, distinct, limits.min_observations));
  if (many(dropped.weak_points))
    lines.push_back(
        fmt::format("{} of {} observations belong to points that only one image sees, or that are "
                    "seen under less than {:.3g} degrees, and are left out",
                    dropped.weak_points, distinct, limits.min_angle));
  return lines;
}

}  // namespace axial::pose
