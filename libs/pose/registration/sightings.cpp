// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/registration/sightings.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numbers>

namespace axial::pose {
namespace {

using Votes = std::map<std::size_t, int>;  // by candidate

// The candidate with the most votes. Of several such candidates, the first.
Votes::value_type winner(const Votes& votes) {
  return *std::ranges::max_element(votes, {}, &Votes::value_type::second);
}

// The number of sightings that agree with the best pose of those that do not agree with `found`.
std::size_t agreeing_otherwise(const BundleCamera& camera, std::span<const Sighting> sightings,
                               const AbsolutePose& found, const AbsolutePoseOptions& options) {
  std::vector<Sighting> others;
  for (std::size_t i = 0; i < sightings.size(); ++i)
    if (!std::ranges::binary_search(found.inliers, i)) others.push_back(sightings[i]);
  return absolute_pose(camera, others, options).inliers.size();
}

std::string few_agree(std::size_t agree, std::size_t all, const PlaceLimits& limits) {
  if (agree < limits.least_sightings)
    return fmt::format("{} of {} matches with points agree with one pose, {} are needed", agree,
                       all, limits.least_sightings);
  if (static_cast<double>(agree) < limits.least_share * static_cast<double>(all))
    return fmt::format("{} of {} matches with points agree with one pose, {:.0f} % are needed",
                       agree, all, 100 * limits.least_share);
  return {};
}

std::string badly_known(const PoseDoubt& doubt, const PlaceLimits& limits) {
  const double degrees = doubt.angle * 180 / std::numbers::pi;
  if (degrees <= limits.most_angle && doubt.centre <= limits.most_centre) return {};
  return fmt::format(
      "its matches with points determine its pose to {:.2g} degrees and {:.2g} % of the distance, "
      "{} degrees and {} % are needed",
      degrees, 100 * doubt.centre, limits.most_angle, 100 * limits.most_centre);
}

}  // namespace

std::vector<Sighting> sightings_of(std::size_t image, const Bundle& bundle,
                                   const FeatureMatches& matches,
                                   const std::vector<std::vector<std::size_t>>& points) {
  std::map<std::uint32_t, Votes> by_feature;
  for (const FeatureLink& link : matches.links(image)) {
    const std::size_t point = points[link.other_image][link.other_feature];
    if (point != kNoPoint) ++by_feature[link.feature][point];
  }
  std::map<std::size_t, Votes> by_point;
  for (const auto& [feature, votes] : by_feature) {
    const auto [point, count] = winner(votes);
    by_point[point][feature] = count;
  }
  std::vector<Sighting> sightings;
  for (const auto& [point, votes] : by_point)
    sightings.push_back(
        {matches.features()[image][winner(votes).first], bundle.points[point].position});
  return sightings;
}

Place place_of(const BundleCamera& camera, std::span<const Sighting> sightings,
               const AbsolutePoseOptions& options, const PlaceLimits& limits) {
  if (sightings.size() < limits.least_sightings)
    return {{},
            fmt::format("{} matches with points, {} are needed", sightings.size(),
                        limits.least_sightings)};
  const AbsolutePose found = absolute_pose(camera, sightings, options);
  Place place{found.pose, few_agree(found.inliers.size(), sightings.size(), limits)};
  if (!place.why_not.empty()) return place;
  const std::size_t second = agreeing_otherwise(camera, sightings, found, options);
  if (static_cast<double>(second) >
      limits.most_of_second * static_cast<double>(found.inliers.size()))
    place.why_not = fmt::format("its matches with points agree with two poses, {} and {} of {}",
                                found.inliers.size(), second, sightings.size());
  else
    place.why_not = badly_known(doubt_of(camera, sightings, found), limits);
  return place;
}

}  // namespace axial::pose
