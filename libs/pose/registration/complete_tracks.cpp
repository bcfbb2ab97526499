// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/registration/complete_tracks.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "base/disjoint_sets.h"
#include "base/parallel.h"

namespace axial::pose {
namespace {

using Ray = refractive::AxialRay<double>;

constexpr int kMostPasses = 5;           // of adding observations
constexpr std::size_t kMostStarts = 40;  // pairs of features from which a point is triangulated
constexpr int kMostPoints = 4;           // from one group of connected features

// A feature of an image.
struct Feature {
  std::size_t image = 0;
  std::uint32_t index = 0;
};

// A point and the features that show it.
struct NewPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::vector<std::size_t> members;  // of a group
};

class Completion {
 public:
  Completion(Bundle& bundle, const FeatureMatches& matches, const ImagesWithPoses& images,
             const TrackLimits& limits)
      : bundle_(bundle),
        matches_(matches),
        images_(images),
        limits_(limits),
        cameras_(cameras_now(bundle)),
        points_(points_of_features(bundle, matches)),
        seen_in_(bundle.points.size()) {
    for (const Observation& observation : bundle.observations)
      seen_in_[observation.point].insert(observation.image);
  }

  std::size_t add_observations();
  std::size_t add_points();

 private:
  const Eigen::Vector2d& pixel_of(const Feature& feature) const {
    return matches_.features()[feature.image][feature.index];
  }
  double error_of(const Feature& feature, const Eigen::Vector3d& point) const;
  std::optional<std::size_t> best_point(const Feature& feature) const;
  void observe(const Feature& feature, std::size_t point);
  std::vector<std::vector<Feature>> groups() const;
  std::vector<NewPoint> points_in(const std::vector<Feature>& group) const;
  std::optional<NewPoint> best_of(const std::vector<Feature>& group, const std::vector<Ray>& rays,
                                  const std::vector<bool>& free) const;
  std::vector<std::array<std::size_t, 2>> starts(const std::vector<Feature>& group,
                                                 const std::vector<bool>& free) const;
  NewPoint seen_from(const Eigen::Vector3d& position, const std::vector<Feature>& group,
                     const std::vector<bool>& free, double& cost) const;
  bool is_good(const NewPoint& point, const std::vector<Feature>& group,
               const std::vector<Ray>& rays) const;

  Bundle& bundle_;
  const FeatureMatches& matches_;
  const ImagesWithPoses& images_;
  const TrackLimits& limits_;
  const std::vector<PhotographCamera> cameras_;
  std::vector<std::vector<std::size_t>> points_;  // by image and feature
  std::vector<std::set<std::size_t>> seen_in_;    // images, by point
};

double Completion::error_of(const Feature& feature, const Eigen::Vector3d& point) const {
  const BundleImage& image = bundle_.images[feature.image];
  return reprojection_error(cameras_[image.camera], image.pose, point, pixel_of(feature));
}

// Of the points that the matches of the feature show, the one with the smallest error.
std::optional<std::size_t> Completion::best_point(const Feature& feature) const {
  std::optional<std::size_t> best;
  double least = limits_.max_error;
  for (const FeatureLink& link : matches_.links(feature.image, feature.index)) {
    const std::size_t point = points_[link.other_image][link.other_feature];
    if (point == kNoPoint || point == best || seen_in_[point].contains(feature.image)) continue;
    const double error = error_of(feature, bundle_.points[point].position);
    if (!(error <= least)) continue;
    least = error;
    best = point;
  }
  return best;
}

void Completion::observe(const Feature& feature, std::size_t point) {
  bundle_.observations.push_back({feature.image, point, pixel_of(feature), feature.index});
  points_[feature.image][feature.index] = point;
  seen_in_[point].insert(feature.image);
}

std::size_t Completion::add_observations() {
  const std::size_t before = bundle_.observations.size();
  std::size_t last = before;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    for (std::size_t image = 0; image < points_.size(); ++image) {
      if (!images_.posed[image]) continue;
      for (std::uint32_t k = 0; k < points_[image].size(); ++k) {
        if (points_[image][k] != kNoPoint) continue;
        if (const auto point = best_point({image, k})) observe({image, k}, *point);
      }
    }
    if (bundle_.observations.size() == last) break;
    last = bundle_.observations.size();
  }
  return last - before;
}

// The groups of two or more features without points that are connected by matches.
std::vector<std::vector<Feature>> Completion::groups() const {
  std::vector<std::size_t> first(points_.size() + 1, 0);  // number of the first feature of an image
  for (std::size_t i = 0; i < points_.size(); ++i) first[i + 1] = first[i] + points_[i].size();
  const auto is_free = [&](std::size_t image, std::uint32_t feature) {
    return images_.posed[image] && points_[image][feature] == kNoPoint;
  };
  DisjointSets<std::size_t> sets(first.back());
  for (std::size_t image = 0; image < points_.size(); ++image)
    for (const FeatureLink& link : matches_.links(image))
      if (is_free(image, link.feature) && is_free(link.other_image, link.other_feature))
        sets.join(first[image] + link.feature, first[link.other_image] + link.other_feature);
  std::map<std::size_t, std::vector<Feature>> by_root;
  for (std::size_t image = 0; image < points_.size(); ++image)
    for (std::uint32_t k = 0; k < points_[image].size(); ++k)
      if (is_free(image, k)) by_root[sets.root(first[image] + k)].push_back({image, k});
  std::vector<std::vector<Feature>> groups;
  for (auto& [root, group] : by_root)
    if (group.size() >= 2) groups.push_back(std::move(group));
  return groups;
}

// Matched pairs of the group: members that are free, evenly spaced if there are many.
std::vector<std::array<std::size_t, 2>> Completion::starts(const std::vector<Feature>& group,
                                                           const std::vector<bool>& free) const {
  const auto key = [](const Feature& feature) { return std::pair(feature.image, feature.index); };
  std::vector<std::array<std::size_t, 2>> pairs;
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (!free[i]) continue;
    for (const FeatureLink& link : matches_.links(group[i].image, group[i].index)) {
      // Members are sorted by image and feature.
      const std::pair<std::size_t, std::uint32_t> wanted(link.other_image, link.other_feature);
      const auto found = std::ranges::lower_bound(group, wanted, {}, key);
      if (found == group.end() || key(*found) != wanted) continue;
      const auto other = static_cast<std::size_t>(found - group.begin());
      if (other > i && free[other]) pairs.push_back({i, other});
    }
  }
  if (pairs.size() <= kMostStarts) return pairs;
  std::vector<std::array<std::size_t, 2>> chosen;
  for (std::size_t k = 0; k < kMostStarts; ++k)
    chosen.push_back(pairs[k * pairs.size() / kMostStarts]);
  return chosen;
}

// The free members that may show a point at `position`: the nearest one of each image. `cost`: the
// sum of their squared errors.
NewPoint Completion::seen_from(const Eigen::Vector3d& position, const std::vector<Feature>& group,
                               const std::vector<bool>& free, double& cost) const {
  NewPoint point{position, {}};
  double least = 0;
  cost = 0;
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (!free[i]) continue;
    const double error = error_of(group[i], position);
    if (!(error <= limits_.max_error)) continue;
    const bool again =
        !point.members.empty() && group[point.members.back()].image == group[i].image;
    if (again && error >= least) continue;
    if (again) {
      point.members.pop_back();
      cost -= least * least;
    }
    point.members.push_back(i);
    cost += error * error;
    least = error;
  }
  return point;
}

bool Completion::is_good(const NewPoint& point, const std::vector<Feature>& group,
                         const std::vector<Ray>& rays) const {
  bool fresh = false;
  std::vector<Ray> own;
  for (const std::size_t member : point.members) {
    fresh = fresh || images_.fresh[group[member].image];
    own.push_back(rays[member]);
  }
  return point.members.size() >= (fresh ? 2u : 3u) &&
         widest_angle(own) >= limits_.min_angle * std::numbers::pi / 180;
}

// The point that most free members show; of several, the one with the smallest errors.
std::optional<NewPoint> Completion::best_of(const std::vector<Feature>& group,
                                            const std::vector<Ray>& rays,
                                            const std::vector<bool>& free) const {
  std::optional<NewPoint> best;
  double least = 0;
  for (const auto& [i, j] : starts(group, free)) {
    const auto start = triangulate(std::array{rays[i], rays[j]});
    if (!start) continue;
    double cost = 0;
    const NewPoint point = seen_from(*start, group, free, cost);
    std::vector<Ray> own;
    for (const std::size_t member : point.members) own.push_back(rays[member]);
    const auto position = triangulate(own);
    if (!position) continue;
    NewPoint improved = seen_from(*position, group, free, cost);
    if (!is_good(improved, group, rays)) continue;
    const bool more = !best || improved.members.size() > best->members.size();
    if (!more && (improved.members.size() < best->members.size() || cost >= least)) continue;
    best = std::move(improved);
    least = cost;
  }
  return best;
}

std::vector<NewPoint> Completion::points_in(const std::vector<Feature>& group) const {
  std::vector<Ray> rays;
  std::vector<bool> free;
  for (const Feature& feature : group) {
    const BundleImage& image = bundle_.images[feature.image];
    rays.push_back(world_ray(cameras_[image.camera], image.pose, pixel_of(feature)));
    free.push_back(rays.back().direction.allFinite());
  }
  std::vector<NewPoint> points;
  for (int k = 0; k < kMostPoints; ++k) {
    std::optional<NewPoint> best = best_of(group, rays, free);
    if (!best) break;
    for (const std::size_t member : best->members) free[member] = false;
    points.push_back(*std::move(best));
  }
  return points;
}

std::size_t Completion::add_points() {
  const std::vector<std::vector<Feature>> all = groups();
  std::vector<std::vector<NewPoint>> found(all.size());
  parallel_for(
      all.size(), [&](std::size_t i) { found[i] = points_in(all[i]); }, 16);
  std::size_t source = images_.last_source, added = 0;
  for (const BundlePoint& point : bundle_.points) source = std::max(source, point.source);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const NewPoint& point : found[i]) {
      bundle_.points.push_back({point.position, ++source});
      seen_in_.emplace_back();
      for (const std::size_t member : point.members)
        observe(all[i][member], bundle_.points.size() - 1);
      ++added;
    }
  return added;
}

}  // namespace

CompletedTracks complete_tracks(Bundle& bundle, const FeatureMatches& matches,
                                const ImagesWithPoses& images, const TrackLimits& limits) {
  Completion completion(bundle, matches, images, limits);
  CompletedTracks added;
  added.observations = completion.add_observations();
  added.points = completion.add_points();
  return added;
}

}  // namespace axial::pose
