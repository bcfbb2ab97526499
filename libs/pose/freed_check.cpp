// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/freed_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "pose/free_numbers.h"
#include "pose/track_sample.h"
#include "scene/decompositions.h"

namespace axial::pose {
namespace {

constexpr SampleLimits kLimits{2000, 40, 40, 1};
constexpr double kLeastDeviations = 4;
constexpr double kLeastEffect = 0.001;

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

// Of the candidates, those whose numbers are fixed.
std::vector<std::vector<std::size_t>> fixed_candidates(const Bundle& part,
                                                       const AdjustOptions& options) {
  std::vector<std::vector<std::size_t>> groups = candidates(part);
  const auto& free = options.unknowns(part.cameras.front()).free;
  std::erase_if(groups, [&](const std::vector<std::size_t>& group) {
    return std::ranges::any_of(group, [&](std::size_t number) { return free[number]; });
  });
  return groups;
}

Eigen::Matrix3Xd points_of(const Bundle& part) {
  Eigen::Matrix3Xd places(3, part.points.size());
  Eigen::Index column = 0;
  for (const BundlePoint& point : part.points) places.col(column++) = point.position;
  return places;
}

Eigen::Matrix3Xd centres_of(const Bundle& part) {
  Eigen::Matrix3Xd places(3, part.images.size());
  Eigen::Index column = 0;
  for (const BundleImage& image : part.images) places.col(column++) = image.pose.centre;
  return places;
}

// The RMS of the movements of the points after the best similarity, by their median distance.
double effect_on_shape(const Bundle& before, const Bundle& after) {
  const Eigen::Matrix3Xd from = points_of(after), to = points_of(before);
  const Similarity fit = best_similarity(from, to);
  double sum = 0;
  for (Eigen::Index i = 0; i < from.cols(); ++i)
    sum += (fit(Eigen::Vector3d(from.col(i))) - to.col(i)).squaredNorm();
  return std::sqrt(sum / static_cast<double>(from.cols())) / median_distance(before);
}

// The RMS of the relative changes of the distances between cameras and points, after a change of
// the scale that keeps the distances between the cameras.
double effect_on_distances(const Bundle& before, const Bundle& after) {
  const double scale = best_similarity(centres_of(after), centres_of(before)).scale;
  double sum = 0;
  for (const Observation& one : before.observations) {
    const auto distance = [&](const Bundle& part) {
      return (part.points[one.point].position - part.images[one.image].pose.centre).norm();
    };
    const double change = scale * distance(after) / distance(before) - 1;
    sum += change * change;
  }
  return std::sqrt(sum / static_cast<double>(before.observations.size()));
}

// Frees the numbers of `group`. `stated`: the part, adjusted with `held`, and its RMS error.
FreedNumber freed_from(const Bundle& stated, double rms_stated, const AdjustOptions& held,
                       const std::vector<std::size_t>& group) {
  AdjustOptions freeing = held;
  for (const std::size_t number : group) freeing.free[number] = true;
  Bundle trial = stated;
  const double found = adjusted_rms(trial, freeing);
  FreedNumber freed = moved_most(stated, trial, freeing);
  freed.rms_stated = rms_stated;
  freed.rms_found = found;
  const double gain = std::max(0.0, rms_stated * rms_stated - found * found);
  freed.deviations = std::sqrt(static_cast<double>(stated.observations.size()) * gain) /
                     observed_pixel_sigma(trial, freeing);
  freed.effect = std::max(effect_on_shape(stated, trial), effect_on_distances(stated, trial));
  return freed;
}

}  // namespace

std::optional<FreedNumber> number_that_does_not_fit(const Bundle& refined,
                                                    const AdjustOptions& options) {
  Bundle part = sample_bundle(refined, kLimits, true);
  if (part.images.size() < 3 || part.points.size() < 20 || !of_one_kind(part)) return {};
  const auto groups = fixed_candidates(part, options);
  if (groups.empty()) return {};
  std::optional<FreedNumber> best;
  try {
    const AdjustOptions held = options_for(part, options);
    const double stated = adjusted_rms(part, held);
    for (const auto& group : groups) {
      const FreedNumber freed = freed_from(part, stated, held, group);
      if (freed.deviations > kLeastDeviations && freed.effect > kLeastEffect &&
          (!best || freed.rms_found < best->rms_found))
        best = freed;
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
      "deviations away), errors are {:.3f} px instead of {:.3f} px (RMS), and the scene changes by "
      "{:.2g} % of its distance. {}Measure this value again, or adjust it with {}",
      freed.name, value(freed.found), value(freed.stated), deviations, freed.rms_found,
      freed.rms_stated, 100 * freed.effect, lengths, name_of("refine"));
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
