// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/bundle/known.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/disjoint_sets.h"
#include "scene/decompositions.h"

namespace axial::pose {
namespace {

std::string left_out(const BundleImage& image) {
  return fmt::format("image '{}' is left out: too few of its observations fit", image.name);
}

std::optional<std::string> why_lost(const Bundle& bundle, const KnownDistance& known) {
  const bool images = known.between == KnownDistance::Between::images;
  // Connected components of the graph of images and points with observations as edges. Points are
  // numbered after images.
  DisjointSets<std::size_t> sets(bundle.images.size() + bundle.points.size());
  for (const Observation& observation : bundle.observations)
    sets.join(observation.image, bundle.images.size() + observation.point);
  std::vector<std::size_t> roots;
  for (const std::size_t end : {known.first, known.second}) {
    const auto point = std::ranges::find(bundle.points, end, &BundlePoint::source);
    const auto index = images ? end : static_cast<std::size_t>(point - bundle.points.begin());
    const auto of = images ? &Observation::image : &Observation::point;
    if (std::ranges::find(bundle.observations, index, of) == bundle.observations.end())
      return images ? left_out(bundle.images[end])
                    : fmt::format(
                          "point {} is left out: fewer than two of its observations fit, or their "
                          "angle is too small",
                          end);
    roots.push_back(sets.root(images ? index : bundle.images.size() + index));
  }
  if (roots[0] != roots[1]) return "no chain of points connects the two ends";
  return {};
}

std::optional<std::string> why_lost_positions(const Bundle& bundle, const AdjustOptions& options) {
  const std::vector<std::size_t> lost = lost_positions(bundle, options);
  if (lost.empty()) return {};
  const std::string first = left_out(bundle.images[options.positions[lost[0]].image]);
  const std::size_t left = options.positions.size() - lost.size();
  if (left < 3) return fmt::format("{} positions can be used, of at least 3: {}", left, first);
  Eigen::Matrix3Xd places(3, left);
  Eigen::Index column = 0;
  for (std::size_t i = 0; i < options.positions.size(); ++i)
    if (!std::ranges::binary_search(lost, i)) places.col(column++) = options.positions[i].metres;
  if (relative_width(places) < kLineWidth)
    return fmt::format("the {} positions that can be used lie on one line: {}", left, first);
  return {};
}

}  // namespace

Eigen::Vector3d place_in(const Bundle& bundle, KnownDistance::Between of, std::size_t index) {
  if (of == KnownDistance::Between::images) return bundle.images[index].pose.centre;
  return bundle.points[point_of(bundle, index)].position;
}

std::vector<std::size_t> lost_positions(const Bundle& bundle, const AdjustOptions& options) {
  const std::vector<std::size_t> counts = observations_by_image(bundle);
  std::vector<std::size_t> lost;
  for (std::size_t i = 0; i < options.positions.size(); ++i)
    if (counts[options.positions[i].image] == 0) lost.push_back(i);
  return lost;
}

std::vector<std::string> lost_knowledge(const Bundle& bundle, const AdjustOptions& options) {
  std::vector<std::string> reasons;
  for (const KnownDistance& known : options.distances)
    if (auto why = known.name.empty() ? why_lost(bundle, known) : std::nullopt)
      reasons.push_back(*std::move(why));
  if (auto why = why_lost_positions(bundle, options)) reasons.push_back(*std::move(why));
  return reasons;
}

std::pair<Eigen::Matrix3Xd, Eigen::Matrix3Xd> centres_and_positions(
    const Bundle& bundle, const std::vector<KnownPosition>& positions) {
  const auto count = static_cast<Eigen::Index>(positions.size());
  std::pair<Eigen::Matrix3Xd, Eigen::Matrix3Xd> pairs{Eigen::Matrix3Xd(3, count),
                                                      Eigen::Matrix3Xd(3, count)};
  Eigen::Index column = 0;
  for (const KnownPosition& known : positions) {
    pairs.first.col(column) = bundle.images[known.image].pose.centre;
    pairs.second.col(column++) = known.metres;
  }
  return pairs;
}

}  // namespace axial::pose
