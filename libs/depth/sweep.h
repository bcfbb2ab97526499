// SPDX-License-Identifier: GPL-3.0-or-later
// One PatchMatch sweep: rows in strips of fixed height, each walked in reading order (or
// backwards), so that a good hypothesis runs through a whole strip; strips are independent of each
// other, because across a strip's edge they read the state from before the sweep. Same bytes for
// any thread count.
#pragma once

#include <cmath>
#include <opencv2/core.hpp>

#include "base/parallel.h"
#include "depth/matcher.h"
#include "depth/plane_map.h"
#include "depth/random.h"

namespace axial::depth {

inline constexpr int kStripHeight = 32;
inline constexpr std::size_t kMaxCandidates = 8;  // hypotheses of one pixel scored at once

// Mean of the two smallest costs; the second only counts below kOutsideCost.
inline float aggregate(float smallest, float second) {
  return second < kOutsideCost ? 0.5f * (smallest + second) : smallest;
}

struct SweepInput {
  std::uint32_t image_id = 0;
  std::uint32_t sweep = 0;  // unique over levels and passes; odd ones run backwards
  float min_depth = 0;
  float max_depth = 0;
  const cv::Mat1f* prior = nullptr;  // depth from the coarser level, of the map's size
  // Depth that textureless pixels are held to where there is no `prior`: a geometric pass must not
  // lose what the coarser levels filled in.
  const cv::Mat1f* textureless_prior = nullptr;
  const cv::Mat1b* mask = nullptr;  // non-zero: work on this pixel
  int trial_pairs = 0;              // trials around the best hypothesis, at most 4 pairs
  bool first = false;               // fill pixels without a hypothesis at random
};

template <class Matcher>
class Sweep {
 public:
  Sweep(const Matcher& matcher, PlaneMap& map, const PatchMatchOptions& options,
        const SweepInput& input)
      : matcher_(matcher), map_(map), options_(options), input_(input) {
    for (std::size_t i = 0; i < matcher.views(); ++i) all_views_[i] = static_cast<std::uint8_t>(i);
  }

  void run() {
    const int strips = (map_.height + kStripHeight - 1) / kStripHeight;
    save_strip_edges(strips);
    parallel_for(static_cast<std::size_t>(strips),
                 [&](std::size_t strip) { run_strip(static_cast<int>(strip)); });
  }

 private:
  void save_strip_edges(int strips) {
    const auto width = static_cast<std::ptrdiff_t>(map_.width);
    edges_.clear();
    for (int strip = 0; strip + 1 < strips; ++strip) {
      const auto begin = map_.pixels.begin() + ((strip + 1) * kStripHeight - 1) * width;
      edges_.insert(edges_.end(), begin, begin + 2 * width);
    }
  }

  // The pixel next to a strip's own: across the edge, as it was before the sweep.
  const PlanePixel& neighbour(int strip, int x, int y) const {
    const int top = strip * kStripHeight;
    if (y >= top && y < top + kStripHeight) return map_.at(x, y);
    const int edge = y < top ? strip - 1 : strip;
    const int row = y < top ? 0 : 1;
    return edges_[static_cast<std::size_t>((edge * 2 + row) * map_.width + x)];
  }

  void run_strip(int strip) {
    const int top = strip * kStripHeight;
    const int bottom = std::min(top + kStripHeight, map_.height);
    if (input_.sweep % 2 == 0) {
      for (int y = top; y < bottom; ++y)
        for (int x = 0; x < map_.width; ++x) visit(strip, x, y, -1);
    } else {
      for (int y = bottom - 1; y >= top; --y)
        for (int x = map_.width - 1; x >= 0; --x) visit(strip, x, y, +1);
    }
  }

  struct Neighbourhood {
    std::array<SurfacePoint, 4> points{};
    std::size_t count = 0;

    std::span<const SurfacePoint> all() const { return {points.data(), count}; }
  };

  Neighbourhood neighbourhood(int strip, int x, int y) const {
    Neighbourhood around;
    const auto add = [&](int nx, int ny) {
      if (nx < 0 || ny < 0 || nx >= map_.width || ny >= map_.height) return;
      const PlanePixel& pixel = neighbour(strip, nx, ny);
      if (!(pixel.plane.depth > 0)) return;
      const Eigen::Vector3f& p = pixel.point;
      const Eigen::Vector3f& n = pixel.plane.normal;
      around.points[around.count++] = {{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}};
    };
    add(x - 1, y);
    add(x, y - 1);
    add(x + 1, y);
    add(x, y + 1);
    return around;
  }

  bool in_range(float depth) const {
    return depth >= input_.min_depth && depth <= input_.max_depth;
  }

  PlaneHypothesis random_plane(const ReferencePixel& pixel, KeyedRandom& random) const {
    const float low = std::sqrt(input_.min_depth);
    const float root = low + random.unit() * (std::sqrt(input_.max_depth) - low);
    return {root * root, random.facing_normal(pixel.ray.direction)};
  }

  void clear(PlanePixel& pixel) const { pixel = PlanePixel(); }

  // A hypothesis with its cost and the views that see it best.
  struct Best {
    PlaneHypothesis plane;
    float cost = kMaxCost;
    std::array<std::uint8_t, 2> views{};  // best first
    float motion = 0;                     // in the best view [px/m]
  };

  // What every hypothesis of one pixel is judged by.
  struct Visit {
    const ReferencePixel& pixel;
    const Neighbourhood& around;
  };

  void visit(int strip, int x, int y, int step) {
    PlanePixel& current = map_.at(x, y);
    if (!window_inside(x, y, map_.width, map_.height) || (input_.mask && !(*input_.mask)(y, x)))
      return clear(current);
    ReferencePixel pixel = matcher_.pixels().prepare(x, y);
    float prior = input_.prior ? (*input_.prior)(y, x) : 0.0f;
    if (pixel.patch.texture < options_.min_texture) {
      if (input_.textureless_prior) prior = (*input_.textureless_prior)(y, x);
      if (!(prior > 0)) return clear(current);
    }
    matcher_.pixels().set_prior(pixel, prior);

    KeyedRandom random(input_.image_id, map_.index(x, y), input_.sweep);
    if (!(current.plane.depth > 0) || !in_range(current.plane.depth)) {
      if (!input_.first) return clear(current);
      current.plane = random_plane(pixel, random);
    }
    if (!(current.plane.normal.dot(pixel.ray.direction) < 0))
      current.plane.normal = random.facing_normal(pixel.ray.direction);

    const Neighbourhood around = neighbourhood(strip, x, y);
    const Visit at{pixel, around};
    Candidates candidates;
    candidates.add(current.plane);
    if (x + step >= 0 && x + step < map_.width)
      propagate(pixel, neighbour(strip, x + step, y), candidates);
    if (y + step >= 0 && y + step < map_.height)
      propagate(pixel, neighbour(strip, x, y + step), candidates);
    Best best;
    keep_best(at, candidates, best);
    refine(at, random, best);
    current = {best.plane, pixel.ray.at(best.plane.depth), best.cost};
  }

  struct Candidates {
    std::array<PlaneHypothesis, kMaxCandidates> planes;
    std::size_t count = 0;

    void add(const PlaneHypothesis& plane) { planes[count++] = plane; }
    std::span<const PlaneHypothesis> all() const { return {planes.data(), count}; }
  };

  // Eq. (8): where this pixel's ray meets the neighbour's plane. Nothing if that is no news.
  void propagate(const ReferencePixel& pixel, const PlanePixel& from,
                 Candidates& candidates) const {
    if (!(from.plane.depth > 0) || !(from.cost < options_.keep_cost)) return;
    const float along = from.plane.normal.dot(pixel.ray.direction);
    if (!(along < -0.05f)) return;
    const float depth = from.plane.normal.dot(from.point - pixel.ray.origin) / along;
    if (!in_range(depth)) return;
    const PlaneHypothesis plane{depth, from.plane.normal};
    for (const PlaneHypothesis& other : candidates.all())
      if (std::abs(depth - other.depth) < 1e-5f * depth &&
          plane.normal.dot(other.normal) > 0.99999f)
        return;
    candidates.add(plane);
  }

  // Scores the candidates in all views and keeps the best, if it is better than `best`.
  void keep_best(const Visit& at, const Candidates& candidates, Best& best) const {
    const std::size_t views = matcher_.views();
    std::array<ViewScore, kMaxCandidates * kMaxSources> scores;
    matcher_.score(at.pixel, candidates.all(), {all_views_.data(), views}, at.around.all(), scores);
    for (std::size_t p = 0; p < candidates.count; ++p) {
      const ViewScore* of = scores.data() + p * views;
      std::size_t first = 0, second = views;
      for (std::size_t k = 1; k < views; ++k) {
        if (of[k].cost < of[first].cost) {
          second = first;
          first = k;
        } else if (second == views || of[k].cost < of[second].cost) {
          second = k;
        }
      }
      const PlaneHypothesis& plane = candidates.planes[p];
      float cost = second < views ? aggregate(of[first].cost, of[second].cost) : of[first].cost;
      cost *= of[0].smoothness;
      if (p > 0 && !(cost < best.cost)) continue;
      if (second == views) second = first;
      best = {plane, cost, {all_views_[first], all_views_[second]}, of[first].motion};
    }
  }

  // Trials around the best plane, all scored at once in its two best views.
  void refine(const Visit& at, KeyedRandom& random, Best& best) const {
    float scale = 1;
    if (best.cost <= options_.good_cost)
      scale = 0.25f;
    else if (best.cost <= options_.fair_cost)
      scale = 0.5f;
    else if (best.cost >= options_.bad_cost && !restart(at, random, best))
      return;
    const float depth_range = best.motion > 0 ? std::min(options_.refinement_pixels / best.motion,
                                                         0.05f * best.plane.depth)
                                              : 0.003f * best.plane.depth;
    Candidates trials;
    add_trials(at, best.plane, depth_range, scale, random, trials);
    if (trials.count > 0) keep_best_trial(at, trials, best);
  }

  // Pairs of trials on either side of a plane, in turn along the ray and of the normal, ever
  // closer. A trial that moved both at once would seldom be better: near the optimum what one
  // gains the other loses.
  void add_trials(const Visit& at, const PlaneHypothesis& plane, float depth_range, float scale,
                  KeyedRandom& random, Candidates& trials) const {
    const auto add = [&](float depth, const Eigen::Vector3f& normal) {
      if (in_range(depth) && normal.dot(at.pixel.ray.direction) < -0.05f)
        trials.add({depth, normal});
    };
    const Eigen::Vector3f u = plane.normal.unitOrthogonal();
    const Eigen::Vector3f v = plane.normal.cross(u);
    for (int pair = 0; pair < input_.trial_pairs; ++pair) {
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

  void keep_best_trial(const Visit& at, const Candidates& trials, Best& best) const {
    const std::size_t views = best.views[0] == best.views[1] ? 1 : 2;
    std::array<ViewScore, 2 * kMaxCandidates> scores;
    matcher_.score(at.pixel, trials.all(), {best.views.data(), views}, at.around.all(), scores);
    for (std::size_t p = 0; p < trials.count; ++p) {
      const PlaneHypothesis& plane = trials.planes[p];
      const ViewScore* of = scores.data() + p * views;
      float cost = views == 1 ? of[0].cost
                              : aggregate(std::min(of[0].cost, of[1].cost),
                                          std::max(of[0].cost, of[1].cost));
      cost *= of[0].smoothness;
      if (cost < best.cost) {
        best.plane = plane;
        best.cost = cost;
      }
    }
  }

  // A hopeless pixel tries random planes, without the neighbours' say.
  bool restart(const Visit& at, KeyedRandom& random, Best& best) const {
    Candidates candidates;
    for (int trial = 0; trial < options_.restart_trials; ++trial)
      candidates.add(random_plane(at.pixel, random));
    Best other = best;
    keep_best({at.pixel, Neighbourhood()}, candidates, other);
    if (other.cost < best.cost) best = other;
    return best.cost < options_.bad_cost;
  }

  const Matcher& matcher_;
  PlaneMap& map_;
  const PatchMatchOptions& options_;
  SweepInput input_;
  std::array<std::uint8_t, kMaxSources> all_views_{};
  std::vector<PlanePixel> edges_;  // rows above and below each inner strip edge, before the sweep
};

}  // namespace axial::depth
