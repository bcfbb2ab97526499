// SPDX-License-Identifier: GPL-3.0-or-later
// One PatchMatch sweep. The image is divided into strips of rows. The pixels of a strip are
// visited row by row, forwards (from the top left) or backwards (from the bottom right), so that a
// good hypothesis propagates through the whole strip. Across the edge of a strip, pixels read the
// state before the sweep. So strips are independent, and the results are bit-identical for any
// number of threads.
//
// A visit scores the pixel's own plane in at most four views. It scores the planes of the two
// neighbours visited before, each in the two best views of the plane. These are at most eight
// scores (one AVX2 register), whatever the number of views. Then the visit scores trials: planes
// near the best plane (PatchMatchOptions). If there are few trials, they are scored together with
// the other planes (one AVX-512 register). In this case, the best plane is not known yet, so the
// trials lie near the plane with the lowest earlier cost.
//
// In a level's first sweep, a pixel whose plane is not certain tries random planes, too
// (PatchMatchOptions::search_planes). On coarse levels the pixel's own plane and the planes of its
// neighbours are scored in up to five views, because the best views are not known yet and these
// levels have few pixels.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "depth/plane_map.h"
#include "depth/sweep/candidates.h"
#include "depth/sweep/matcher.h"
#include "depth/sweep/random.h"
#include "depth/sweep/strips.h"
#include "depth/sweep/sweep_input.h"

namespace axial::depth {

inline constexpr std::size_t kOwnViews = 4;  // largest number of views for a pixel's own plane
// Largest number of views on coarse levels for a pixel's own plane and the planes of its
// neighbours, and on all levels for the random planes of a restart. The random planes of a search
// are scored in two of the first kManyViews views. More views do not find better planes: the views
// alternate from pixel to pixel, and a plane that is good in one view is propagated together with
// this view.
inline constexpr std::size_t kManyViews = 5;

// One sweep over the planes of `map`. `matcher`: Matcher or LaneMatcher (lane_matcher.h).
template <class Matcher>
class Sweep {
 public:
  // All arguments except `input`, and the images to which `input` points, must outlive the sweep.
  // Preconditions: `map` and the images of `input` have the size of the reference image; there are
  // 1 to kMaxSources source views.
  Sweep(const Matcher& matcher, PlaneMap& map, const PatchMatchOptions& options,
        const SweepInput& input)
      : matcher_(matcher), map_(map), options_(options), input_(input), strips_(map) {
    for (std::size_t i = 0; i < matcher.views(); ++i) all_views_[i] = static_cast<std::uint8_t>(i);
  }

  // Runs the sweep on all threads and changes the map. Returns the number of computed scores. A
  // score is for one plane in one view.
  std::uint64_t run() {
    prepare();
    std::vector<std::uint64_t> scores(static_cast<std::size_t>(strips()));
    parallel_for(scores.size(),
                 [&](std::size_t strip) { scores[strip] = run_strip(static_cast<int>(strip)); });
    return std::accumulate(scores.begin(), scores.end(), std::uint64_t{0});
  }

  // The steps of run(): first prepare(), then run_strip() for each strip, in any order or at the
  // same time. strips() returns the number of strips.
  int strips() const { return strips_.count(); }

  void prepare() { strips_.copy_edges(); }

  // `number`: from 0 to strips() - 1. Returns the number of computed scores.
  std::uint64_t run_strip(int number) {
    const int top = strips_.top(number), bottom = strips_.bottom(number);
    Strip strip{number, {}, 0};
    if (input_.sweep % 2 == 0) {
      for (int y = top; y < bottom; ++y) {
        check_stop(input_.stop);
        for (int x = 0; x < map_.width; ++x) visit(strip, x, y, -1);
      }
    } else {
      for (int y = bottom - 1; y >= top; --y) {
        check_stop(input_.stop);
        for (int x = map_.width - 1; x >= 0; --x) visit(strip, x, y, +1);
      }
    }
    return strip.scores;
  }

 private:
  // The rays of the tile of pixels that was visited last.
  struct Rays {
    int x = -1, y = -1;  // the first pixel of the tile; -1: no tile yet
    RayTile tile;
  };

  struct Strip {
    int number;
    Rays rays;
    std::uint64_t scores;
  };

  const PixelRay& ray(int x, int y, Rays& rays) const {
    const int begin = x - x % kRayTile;
    if (begin != rays.x || y != rays.y) {
      rays.x = begin;
      rays.y = y;
      matcher_.rays(begin, y, rays.tile);
    }
    return rays.tile[static_cast<std::size_t>(x - begin)];
  }

  bool in_range(float depth) const {
    return depth >= input_.min_depth && depth <= input_.max_depth;
  }

  // A random plane with a random normal. The square root of its depth is uniformly distributed over
  // the depth range.
  PlaneHypothesis random_plane(const ReferencePixel& pixel, KeyedRandom& random) const {
    const float low = std::sqrt(input_.min_depth);
    const float root = low + random.unit() * (std::sqrt(input_.max_depth) - low);
    return {root * root, random.facing_normal(pixel.ray.direction)};
  }

  // A random plane perpendicular to the ray. The inverse of its depth is uniformly distributed, so
  // the images of its point in a source view are about uniformly distributed, too.
  PlaneHypothesis facing_plane(const ReferencePixel& pixel, KeyedRandom& random) const {
    const float nearest = 1 / input_.min_depth, farthest = 1 / input_.max_depth;
    return {1 / (farthest + random.unit() * (nearest - farthest)), -pixel.ray.direction};
  }

  void clear(PlanePixel& pixel) const { pixel = PlanePixel(); }

  // The data that the scores of all hypotheses of one pixel need.
  struct Visit {
    const ReferencePixel& pixel;
    const Neighbourhood& around;
    int trial_pairs;
    std::uint64_t& scores;  // number of scores so far
  };

  // NOLINTNEXTLINE(readability-function-size): the inner loop, whose time is measured.
  void visit(Strip& strip, int x, int y, int step) {
    PlanePixel& current = map_.at(x, y);
    if (input_.mask && !(*input_.mask)(y, x)) return clear(current);
    ReferencePixel pixel = matcher_.pixels().prepare(x, y, ray(x, y, strip.rays));
    float prior = input_.prior ? (*input_.prior)(y, x) : 0.0f;
    if (pixel.patch.texture < options_.min_texture) {
      if (input_.textureless_prior) prior = (*input_.textureless_prior)(y, x);
      if (!(prior > 0)) return clear(current);
    }
    matcher_.pixels().set_prior(pixel, prior);

    KeyedRandom random(input_.image_id, map_.index(x, y), input_.sweep);
    if (!(current.plane.depth > 0) || !in_range(current.plane.depth)) {
      if (!input_.first) return clear(current);
      clear(current);
      current.plane = random_plane(pixel, random);
    }
    if (!(current.plane.normal.dot(pixel.ray.direction) < 0)) {
      current.plane.normal = random.facing_normal(pixel.ray.direction);
      current.motion = 0;  // cost and views are those of the old plane
    }

    const Neighbourhood around = strips_.neighbourhood(strip.number, x, y);
    const PlanePixel none;
    const bool beside = x + step >= 0 && x + step < map_.width;
    const bool above = y + step >= 0 && y + step < map_.height;
    const std::array<const PlanePixel*, 2> before{
        beside ? &strips_.neighbour(strip.number, x + step, y) : &none,
        above ? &strips_.neighbour(strip.number, x, y + step) : &none};
    const ViewList own = own_views(x, y, current, before);
    Candidates candidates;
    candidates.add(current.plane, own.all());
    std::optional<BestPlane> likely;
    offer(current.plane, current, likely);
    for (const PlanePixel* from : before) {
      const std::optional<PlaneHypothesis> plane = carried(pixel, *from);
      if (!plane) continue;
      offer(*plane, *from, likely);
      propagate(*plane, *from, own, candidates);
    }
    const bool search =
        input_.first && options_.search_planes > 0 &&
        std::min(current.cost, likely ? likely->cost : kMaxCost) > options_.certain_cost;
    if (search) add_facing_planes(pixel, random, candidates);
    const Visit at{pixel, around, search ? options_.search_pairs : input_.trial_pairs,
                   strip.scores};
    const bool at_once = likely && trials_fit(candidates, at.trial_pairs);
    if (at_once) add_trials(at, *likely, random, candidates);
    BestPlane best;
    keep_best(at, candidates, best);
    if (!at_once || best.cost >= options_.bad_cost) refine(at, random, best);
    current = {best.plane, pixel.ray.at(best.plane.depth), best.cost, best.views, best.motion};
  }

  // The views for the pixel's own plane. If there are few views, these are all views. Otherwise
  // they are the best views of the pixel, the best view of each neighbour visited before, and some
  // other views. The other views take turns, so that a view that was occluded can be chosen again.
  ViewList own_views(int x, int y, const PlanePixel& current,
                     std::span<const PlanePixel* const> before) const {
    ViewList own;
    const std::size_t views = matcher_.views();
    const std::size_t wanted = std::min(views, input_.many_views ? kManyViews : kOwnViews);
    if (wanted < views) {
      for (const std::uint8_t view : current.views) own.add(view);
      for (const PlanePixel* from : before) own.add(from->views[0]);
    }
    add_in_turn(own, static_cast<std::size_t>(x + y) + input_.sweep, wanted);
    return own;
  }

  void add_in_turn(ViewList& own, std::size_t turn, std::size_t wanted) const {
    add_in_turn(own, turn, wanted, matcher_.views());
  }

  // Adds the views turn, turn + 1, ... (modulo `of`) until `own` has `wanted` views.
  void add_in_turn(ViewList& own, std::size_t turn, std::size_t wanted, std::size_t of) const {
    for (; own.count < wanted; ++turn) own.add(all_views_[turn % of]);
  }

  // Returns the plane of the neighbour `from`, with the depth at which the ray of `pixel` meets the
  // plane (eq. 8). Returns no value if the neighbour has no plane, if the plane's cost is keep_cost
  // or more, if the ray grazes the plane, or if the depth is out of range.
  std::optional<PlaneHypothesis> carried(const ReferencePixel& pixel,
                                         const PlanePixel& from) const {
    if (!(from.plane.depth > 0) || !(from.cost < options_.keep_cost)) return {};
    const float along = from.plane.normal.dot(pixel.ray.direction);
    if (!(along < -0.05f)) return {};
    const float depth = from.plane.normal.dot(from.point - pixel.ray.origin) / along;
    if (!in_range(depth)) return {};
    return PlaneHypothesis{depth, from.plane.normal};
  }

  // Adds a neighbour's plane, unless a candidate is nearly the same plane. `from`: the neighbour.
  void propagate(const PlaneHypothesis& plane, const PlanePixel& from, const ViewList& own,
                 Candidates& candidates) const {
    for (const PlaneHypothesis& other : candidates.all())
      if (std::abs(plane.depth - other.depth) < 1e-5f * plane.depth &&
          plane.normal.dot(other.normal) > 0.99999f)
        return;
    if (input_.many_views)
      candidates.add(plane, own.all());
    else if (from.views[0] == kNoView)
      candidates.add(plane, own.all().first(std::min(own.count, from.views.size())));
    else
      candidates.add(plane, distinct(from.views));
  }

  // Adds random planes from the whole depth range. They find surfaces that no neighbour has, such
  // as thin structures, whose pixels match the background at a fair cost.
  void add_facing_planes(const ReferencePixel& pixel, KeyedRandom& random,
                         Candidates& candidates) const {
    const std::size_t of = std::min(matcher_.views(), kManyViews);
    for (int i = 0; i < options_.search_planes; ++i) {
      ViewList tried;
      const PlaneHypothesis plane = facing_plane(pixel, random);
      const auto turn = static_cast<std::size_t>(random.unit() * static_cast<float>(of));
      add_in_turn(tried, turn, std::min(of, BestViews().size()), of);
      candidates.add(plane, tried.all());
    }
  }

  // `likely` is the expected best plane of the visited pixel. Sets `likely` to `plane` if the cost
  // that `plane` has at pixel `from` is lower than the cost of `likely`, or lower than
  // options_.bad_cost if `likely` is empty. A plane with motion 0 is ignored, because this level or
  // pass has not scored it yet. In a geometric pass, only the planes of the neighbours visited
  // before have scores.
  void offer(const PlaneHypothesis& plane, const PlanePixel& from,
             std::optional<BestPlane>& likely) const {
    if (from.motion > 0 && from.cost < (likely ? likely->cost : options_.bad_cost))
      likely = BestPlane{plane, from.cost, from.views, from.motion};
  }

  bool trials_fit(const Candidates& candidates, int pairs) const {
    return !input_.many_views && pairs > 0 &&
           candidates.count + 2 * static_cast<std::size_t>(pairs) <= kMaxCandidates;
  }

  // Scores the candidates. Sets `best` to the candidate with the lowest cost if this cost is lower
  // than the cost of `best`.
  void keep_best(const Visit& at, const Candidates& candidates, BestPlane& best) const {
    std::array<PlaneScore, kMaxCandidates * kMaxSources> scores;
    const std::span<const ScorePair> pairs = candidates.all_pairs();
    matcher_.score(at.pixel, candidates.all(), pairs, at.around.all(), scores);
    at.scores += pairs.size();
    std::size_t winner = pairs.size();  // first pair of the best plane
    for (std::size_t i = 0; i < pairs.size();) {
      constexpr float kNone = std::numeric_limits<float>::max();
      float smallest = kNone, second = kNone;
      const std::size_t begin = i;
      for (; i < pairs.size() && pairs[i].plane == pairs[begin].plane; ++i) {
        second = std::min(second, std::max(smallest, scores[i].cost));
        smallest = std::min(smallest, scores[i].cost);
      }
      const float cost = aggregate(smallest, second) * scores[begin].smoothness;
      if (!(cost < best.cost)) continue;
      best.cost = cost;
      winner = begin;
    }
    if (winner == pairs.size()) return;
    std::size_t first = winner, second = winner;
    for (std::size_t i = winner + 1; i < pairs.size() && pairs[i].plane == pairs[winner].plane; ++i)
      if (scores[i].cost < scores[first].cost)
        second = std::exchange(first, i);
      else if (second == first || scores[i].cost < scores[second].cost)
        second = i;
    best.plane = candidates.planes[pairs[winner].plane];
    best.views = {pairs[first].view, pairs[second].view};
    best.motion = scores[first].motion;
  }

  // If the best plane has a bad cost, tries random planes (restart). Unless the cost stays bad,
  // scores trials near the best plane, all at once in the two best views of the plane.
  void refine(const Visit& at, KeyedRandom& random, BestPlane& best) const {
    if (best.cost >= options_.bad_cost && !restart(at, random, best)) return;
    if (at.trial_pairs == 0) return;
    Candidates trials;
    add_trials(at, best, random, trials);
    keep_best(at, trials, best);
  }

  // The factor of the ranges of the first trials. Better planes have a smaller factor.
  float trial_scale(float cost) const {
    if (cost <= options_.good_cost) return 0.25f;
    return cost <= options_.fair_cost ? 0.5f : 1.0f;
  }

  // Adds pairs of trials, with one trial on either side of the plane. Pairs change depth and normal
  // in turn, with decreasing ranges. No trial changes both, because such a trial is seldom better:
  // near the optimum, one change loses what the other gains.
  void add_trials(const Visit& at, const BestPlane& best, KeyedRandom& random,
                  Candidates& trials) const {
    const float depth_range = best.motion > 0 ? std::min(options_.refinement_pixels / best.motion,
                                                         0.05f * best.plane.depth)
                                              : 0.003f * best.plane.depth;
    float scale = trial_scale(best.cost);
    const PlaneHypothesis& plane = best.plane;
    const auto add = [&](float depth, const Eigen::Vector3f& normal) {
      if (in_range(depth) && normal.dot(at.pixel.ray.direction) < -0.05f)
        trials.add({depth, normal}, distinct(best.views));
    };
    const Eigen::Vector3f u = plane.normal.unitOrthogonal();
    const Eigen::Vector3f v = plane.normal.cross(u);
    for (int pair = 0; pair < at.trial_pairs; ++pair) {
      const std::array<float, 3> step = random.symmetric_triple();
      if (pair % 2 == 0) {
        const float move = step[0] * depth_range * scale;
        add(plane.depth + move, plane.normal);
        add(plane.depth - move, plane.normal);
      } else {
        const float turn = options_.refinement_angle * scale;
        const Eigen::Vector3f tilt = (step[1] * turn) * u + (step[2] * turn) * v;
        const float inv_norm = 1 / std::sqrt(1 + tilt.squaredNorm());
        add(plane.depth, (plane.normal + tilt) * inv_norm);
        add(plane.depth, (plane.normal - tilt) * inv_norm);
      }
      scale *= options_.refinement_shrink;
    }
  }

  // For a pixel with a bad cost: tries random planes in many views, without the smoothness
  // factors. Returns false if the cost stays bad.
  bool restart(const Visit& at, KeyedRandom& random, BestPlane& best) const {
    Candidates candidates;
    const std::size_t views = matcher_.views();
    for (int trial = 0; trial < options_.restart_trials; ++trial) {
      ViewList tried;
      const PlaneHypothesis plane = random_plane(at.pixel, random);
      const std::size_t turn =
          views > kManyViews ? static_cast<std::size_t>(random.unit() * static_cast<float>(views))
                             : 0;
      add_in_turn(tried, turn, std::min(views, kManyViews));
      candidates.add(plane, tried.all());
    }
    keep_best({at.pixel, Neighbourhood(), at.trial_pairs, at.scores}, candidates, best);
    return best.cost < options_.bad_cost;
  }

  const Matcher& matcher_;
  PlaneMap& map_;
  const PatchMatchOptions& options_;
  SweepInput input_;
  Strips strips_;
  std::array<std::uint8_t, kMaxSources> all_views_{};
};

}  // namespace axial::depth
