// SPDX-License-Identifier: GPL-3.0-or-later
#include "diagnosis/refined_check.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "diagnosis/hypotheses.h"
#include "diagnosis/track_sample.h"
#include "pose/adjust/free_numbers.h"
#include "pose/adjust/uncertainty.h"
#include "pose/refine.h"
#include "scene/decompositions.h"

namespace axial::diagnosis {
namespace {

using pose::AdjustOptions;
using pose::Bundle;
using pose::HousingNumber;

constexpr double kMostDeviations = 3;  // of a number that was adjusted
constexpr double kLeastDeviations = 4, kLeastEffect = 0.001;

AdjustOptions options_for(const Bundle& part, const AdjustOptions& options) {
  AdjustOptions result;
  result.poses_known = options.poses_known;
  result.pixel_sigma = std::max(1e-3, observed_pixel_sigma(part, result));
  result.loss_sigmas = 4;
  result.max_iterations = 20;
  if (!options.poses_known) result.distances = held_length(part);
  return result;
}

double adjusted_rms(Bundle& part, const AdjustOptions& options) {
  adjust(part, options);
  return pose::root_mean_square(reprojection_errors(part));
}

// The free number of the first camera that changed most.
HousingNumber moved_most(const Bundle& after, const AdjustOptions& options) {
  const std::vector<HousingNumber> numbers = free_values(after, {}, options);
  return *std::ranges::max_element(
      numbers.begin(),
      std::ranges::find_if(numbers, [](const HousingNumber& number) { return number.camera > 0; }),
      {}, [](const HousingNumber& number) { return std::abs(number.change); });
}

// The points as columns, and the camera centres.
Eigen::Matrix3Xd points_of(const Bundle& part) {
  Eigen::Matrix3Xd places(3, part.points.size());
  Eigen::Index column = 0;
  for (const pose::BundlePoint& point : part.points) places.col(column++) = point.position;
  return places;
}

Eigen::Matrix3Xd centres_of(const Bundle& part) {
  Eigen::Matrix3Xd places(3, part.images.size());
  Eigen::Index column = 0;
  for (const pose::BundleImage& image : part.images) places.col(column++) = image.pose.centre;
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
  for (const pose::Observation& one : before.observations) {
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
                       const pose::NumberGroup& group) {
  AdjustOptions freeing = held;
  std::fill_n(freeing.free.begin() + static_cast<std::ptrdiff_t>(group.first), group.count, true);
  Bundle trial = stated;
  const double found = adjusted_rms(trial, freeing);
  FreedNumber freed{moved_most(trial, freeing), rms_stated, found, 0, 0};
  const double gain = std::max(0.0, rms_stated * rms_stated - found * found);
  freed.deviations = std::sqrt(static_cast<double>(stated.observations.size()) * gain) /
                     observed_pixel_sigma(trial, freeing);
  freed.effect = std::max(effect_on_shape(stated, trial), effect_on_distances(stated, trial));
  return freed;
}

}  // namespace

std::vector<HousingNumber> moved_numbers(const Bundle& refined, const AdjustOptions& options) {
  std::vector<HousingNumber> numbers = free_values(refined, {}, options);
  std::erase_if(numbers, [](const HousingNumber& number) {
    return !(number.sigma_before > 0 &&
             std::abs(number.change) / number.sigma_before > kMostDeviations);
  });
  return numbers;
}

std::optional<FreedNumber> number_that_does_not_fit(const Bundle& refined,
                                                    const AdjustOptions& options) {
  Bundle part = sample_bundle(refined, 2000, true);
  const std::optional<pose::PortKind> kind = common_kind(part);
  if (!is_enough(part) || !kind) return {};
  std::vector<pose::NumberGroup> groups = groups_to_free(*kind);
  const auto& free = options.unknowns(part.cameras.front()).free;
  std::erase_if(groups, [&](const pose::NumberGroup& group) {
    const auto first = free.begin() + static_cast<std::ptrdiff_t>(group.first);
    return std::count(first, first + static_cast<std::ptrdiff_t>(group.count), true) > 0;
  });
  if (groups.empty()) return {};
  std::optional<FreedNumber> best;
  try {
    const AdjustOptions held = options_for(part, options);
    const double stated = adjusted_rms(part, held);
    for (const pose::NumberGroup& group : groups) {
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

}  // namespace axial::diagnosis
