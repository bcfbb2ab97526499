// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/matched_survey.h"

#include <random>
#include <vector>

namespace axial::pose::testing {
namespace {

// Numbers the features of each image in the order of its observations.
FeatureMatches number_features(Bundle& bundle) {
  std::vector<std::vector<Eigen::Vector2d>> features(bundle.images.size());
  for (Observation& observation : bundle.observations) {
    observation.source = features[observation.image].size();
    features[observation.image].push_back(observation.pixel);
  }
  return FeatureMatches(std::move(features));
}

void add_right(FeatureMatches& matches, const Bundle& bundle) {
  std::vector<std::vector<const Observation*>> tracks(bundle.points.size());
  for (const Observation& observation : bundle.observations)
    tracks[observation.point].push_back(&observation);
  const auto number = [](std::size_t value) { return static_cast<std::uint32_t>(value); };
  for (const auto& track : tracks)
    for (std::size_t i = 0; i < track.size(); ++i)
      for (std::size_t j = i + 1; j < track.size(); ++j)
        matches.add(number(track[i]->image), number(track[i]->source), number(track[j]->image),
                    number(track[j]->source));
}

void add_wrong(FeatureMatches& matches, int count) {
  std::mt19937_64 random(7);
  const auto& features = matches.features();
  const auto any = [&](std::uint32_t image) {
    return static_cast<std::uint32_t>(random() % features[image].size());
  };
  for (std::uint32_t i = 0; i < features.size(); ++i)
    for (std::uint32_t j = i + 1; j < features.size(); ++j)
      for (int k = 0; k < count; ++k) {
        const std::uint32_t feature = any(i);
        matches.add(i, feature, j, any(j));
      }
}

}  // namespace

void leave_out(Bundle& bundle, const std::set<std::size_t>& left_out) {
  std::erase_if(bundle.observations, [&](const Observation& observation) {
    return left_out.contains(observation.image);
  });
  for (const std::size_t image : left_out) bundle.images[image].pose = {};
  std::vector<std::size_t> seen(bundle.points.size());
  for (const Observation& observation : bundle.observations) ++seen[observation.point];
  std::vector<std::size_t> place(seen.size());
  std::vector<BundlePoint> points;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    place[i] = points.size();
    if (seen[i] >= 2) points.push_back(bundle.points[i]);
  }
  std::erase_if(bundle.observations,
                [&](const Observation& observation) { return seen[observation.point] < 2; });
  for (Observation& observation : bundle.observations) observation.point = place[observation.point];
  bundle.points = std::move(points);
}

MatchedSurvey matched_survey(const Bundle& truth, const std::set<std::size_t>& left_out,
                             int wrong) {
  MatchedSurvey result{truth, {}, FeatureMatches({})};
  result.matches = number_features(result.truth);
  add_right(result.matches, result.truth);
  add_wrong(result.matches, wrong);
  result.matches.sort();
  result.bundle = result.truth;
  leave_out(result.bundle, left_out);
  return result;
}

}  // namespace axial::pose::testing
