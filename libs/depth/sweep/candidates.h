// SPDX-License-Identifier: GPL-3.0-or-later
// The planes that are scored for one pixel at once, each in its own views.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "depth/plane_map.h"
#include "depth/sweep/matcher.h"

namespace axial::depth {

inline constexpr std::size_t kMaxCandidates = 8;  // hypotheses of one pixel scored at once

// Returns the cost of a plane from its costs in several views. `smallest` and `second` are the two
// smallest of these costs. The result is the mean of both, or `smallest` alone if `second` is
// kOutsideCost or more. For a plane with a cost in one view only, pass as `second` any number from
// kOutsideCost on.
inline float aggregate(float smallest, float second) {
  return second < kOutsideCost ? 0.5f * (smallest + second) : smallest;
}

// Indices of source views without repetition, in the order in which they were added.
struct ViewList {
  std::array<std::uint8_t, kMaxSources> views;
  std::size_t count = 0;

  std::span<const std::uint8_t> all() const { return {views.data(), count}; }

  // Adds `view`, unless it is kNoView or in the list already.
  void add(std::uint8_t view) {
    const auto end = views.begin() + static_cast<std::ptrdiff_t>(count);
    if (view != kNoView && std::find(views.begin(), end, view) == end) views[count++] = view;
  }
};

// Returns the one or two different views in `views`. The span refers to `views`. Precondition: the
// views are not kNoView.
inline std::span<const std::uint8_t> distinct(const BestViews& views) {
  return {views.data(), views[0] == views[1] ? 1u : 2u};
}

// Planes and the views in which each plane is scored. The pairs of one plane are consecutive, and
// the pairs are in the order of the planes.
struct Candidates {
  std::array<PlaneHypothesis, kMaxCandidates> planes;
  std::array<ScorePair, kMaxCandidates * kMaxSources> pairs;
  std::size_t count = 0, pair_count = 0;

  // Adds a plane that is scored in `views`. Preconditions: there are fewer than kMaxCandidates
  // planes; at most kMaxSources views.
  void add(const PlaneHypothesis& plane, std::span<const std::uint8_t> views) {
    for (const std::uint8_t view : views)
      pairs[pair_count++] = {static_cast<std::uint8_t>(count), view};
    planes[count++] = plane;
  }
  std::span<const PlaneHypothesis> all() const { return {planes.data(), count}; }
  std::span<const ScorePair> all_pairs() const { return {pairs.data(), pair_count}; }
};

// A hypothesis with its cost and its best views.
struct BestPlane {
  PlaneHypothesis plane;
  float cost = std::numeric_limits<float>::max();
  BestViews views{kNoView, kNoView};
  float motion = 0;  // PlaneScore::motion in the best view [px/m]; 0: not visible or not known
};

}  // namespace axial::depth
