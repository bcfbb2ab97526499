// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/registration/feature_matches.h"

#include <algorithm>
#include <tuple>

#include "base/parallel.h"

namespace axial::pose {
namespace {

auto key_of(const FeatureLink& link) {
  return std::tuple(link.feature, link.other_image, link.other_feature);
}

}  // namespace

void FeatureMatches::add(std::uint32_t image, std::uint32_t feature, std::uint32_t other_image,
                         std::uint32_t other_feature) {
  links_[image].push_back({feature, other_image, other_feature});
  links_[other_image].push_back({other_feature, image, feature});
}

void FeatureMatches::sort() {
  parallel_for(links_.size(), [&](std::size_t image) {
    std::vector<FeatureLink>& own = links_[image];
    std::ranges::sort(own, {}, key_of);
    const auto same = [](const FeatureLink& a, const FeatureLink& b) {
      return key_of(a) == key_of(b);
    };
    own.erase(std::unique(own.begin(), own.end(), same), own.end());
  });
}

std::span<const FeatureLink> FeatureMatches::links(std::size_t image, std::uint32_t feature) const {
  const std::vector<FeatureLink>& all = links_[image];
  const auto begin = std::ranges::lower_bound(all, feature, {}, &FeatureLink::feature);
  return {begin, std::ranges::upper_bound(begin, all.end(), feature, {}, &FeatureLink::feature)};
}

std::vector<std::vector<std::size_t>> points_of_features(const Bundle& bundle,
                                                         const FeatureMatches& matches) {
  std::vector<std::vector<std::size_t>> points;
  for (const auto& features : matches.features()) points.emplace_back(features.size(), kNoPoint);
  for (const Observation& observation : bundle.observations)
    points[observation.image][observation.source] = observation.point;
  return points;
}

}  // namespace axial::pose
