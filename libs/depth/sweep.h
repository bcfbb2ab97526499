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
  bool first = false;               // fill pixels without a hypothesis at random
};

template <class Camera, class Warp>
class Sweep {
 public:
  Sweep(const Matcher<Camera, Warp>& matcher, PlaneMap& map, const PatchMatchOptions& options,
        const SweepInput& input)
      : matcher_(matcher), map_(map), options_(options), input_(input) {}

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
    std::array<const PlanePixel*, 4> pixels{};
    std::size_t count = 0;
  };

  Neighbourhood neighbourhood(int strip, int x, int y) const {
    Neighbourhood around;
    const auto add = [&](int nx, int ny) {
      if (nx < 0 || ny < 0 || nx >= map_.width || ny >= map_.height) return;
      const PlanePixel& pixel = neighbour(strip, nx, ny);
      if (pixel.plane.depth > 0) around.pixels[around.count++] = &pixel;
    };
    add(x - 1, y);
    add(x, y - 1);
    add(x + 1, y);
    add(x, y + 1);
    return around;
  }

  // Multiplicative bonus for agreeing with the neighbours: eq. (6) with d_v = n . (X_n - X).
  float smoothness(const Neighbourhood& around, const PlaneHypothesis& plane,
                   const Eigen::Vector3f& point) const {
    float factor = 1;
    const float inverse_range2 = 1.0f / point.squaredNorm();
    const float depth_scale =
        -0.5f / (options_.smoothness_depth_sigma * options_.smoothness_depth_sigma);
    const float normal_scale =
        -0.5f / (options_.smoothness_normal_sigma * options_.smoothness_normal_sigma);
    for (std::size_t i = 0; i < around.count; ++i) {
      const PlanePixel& other = *around.pixels[i];
      const float distance = plane.normal.dot(other.point - point);
      const float versine = 1.0f - std::min(1.0f, plane.normal.dot(other.plane.normal));
      const float angle2 = versine * (2.0f + versine / 3.0f);  // angle^2 up to the 6th order
      factor *= 1.0f - options_.smoothness_depth_bonus *
                           std::exp(depth_scale * distance * distance * inverse_range2);
      factor *= 1.0f - options_.smoothness_normal_bonus * std::exp(normal_scale * angle2);
    }
    return factor;
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

  void visit(int strip, int x, int y, int step) {
    PlanePixel& current = map_.at(x, y);
    if (!window_inside(x, y, map_.width, map_.height) || (input_.mask && !(*input_.mask)(y, x)))
      return clear(current);
    ReferencePixel pixel = matcher_.prepare(x, y);
    float prior = input_.prior ? (*input_.prior)(y, x) : 0.0f;
    if (pixel.patch.texture < options_.min_texture) {
      if (input_.textureless_prior) prior = (*input_.textureless_prior)(y, x);
      if (!(prior > 0)) return clear(current);
    }
    matcher_.set_prior(pixel, prior);

    const std::uint64_t index = map_.index(x, y);
    KeyedRandom random(input_.image_id, index, input_.sweep);
    if (!(current.plane.depth > 0) || !in_range(current.plane.depth)) {
      if (!input_.first) return clear(current);
      current.plane = random_plane(pixel, random);
    }
    if (!(current.plane.normal.dot(pixel.ray.direction) < 0))
      current.plane.normal = random.facing_normal(pixel.ray.direction);

    const Neighbourhood around = neighbourhood(strip, x, y);
    Best best{current.plane, 0, {}};
    best.cost = matcher_.score_all(pixel, best.plane, best.views) *
                smoothness(around, best.plane, pixel.ray.at(best.plane.depth));
    if (x + step >= 0 && x + step < map_.width)
      propagate(pixel, neighbour(strip, x + step, y), around, best);
    if (y + step >= 0 && y + step < map_.height)
      propagate(pixel, neighbour(strip, x, y + step), around, best);
    refine(pixel, around, random, best);
    current = {best.plane, pixel.ray.at(best.plane.depth), best.cost};
  }

  struct Best {
    PlaneHypothesis plane;
    float cost;
    ViewCosts views;
  };

  // Eq. (8): where this pixel's ray meets the neighbour's plane.
  void propagate(const ReferencePixel& pixel, const PlanePixel& from, const Neighbourhood& around,
                 Best& best) const {
    if (!(from.plane.depth > 0) || !(from.cost < options_.keep_cost)) return;
    const float along = from.plane.normal.dot(pixel.ray.direction);
    if (!(along < -0.05f)) return;
    const float depth = from.plane.normal.dot(from.point - pixel.ray.origin) / along;
    if (!in_range(depth)) return;
    const PlaneHypothesis plane{depth, from.plane.normal};
    const bool same = std::abs(depth - best.plane.depth) < 1e-5f * depth &&
                      plane.normal.dot(best.plane.normal) > 0.99999f;
    if (same) return;
    ViewCosts views;
    const float cost =
        matcher_.score_all(pixel, plane, views) * smoothness(around, plane, pixel.ray.at(depth));
    if (cost < best.cost) best = {plane, cost, views};
  }

  void refine(const ReferencePixel& pixel, const Neighbourhood& around, KeyedRandom& random,
              Best& best) const {
    float scale = 1;
    if (best.cost <= options_.good_cost)
      scale = 0.25f;
    else if (best.cost <= options_.fair_cost)
      scale = 0.5f;
    else if (best.cost >= options_.bad_cost && !restart(pixel, random, best))
      return;
    const float motion = matcher_.pixels_per_metre(pixel, best.plane.depth, best.views.order[0]);
    const float depth_range =
        motion > 0 ? std::min(options_.refinement_pixels / motion, 0.05f * best.plane.depth)
                   : 0.003f * best.plane.depth;
    for (int trial = 0; trial < options_.refinement_trials; ++trial) {
      PlaneHypothesis plane;
      plane.depth = best.plane.depth + random.symmetric() * depth_range * scale;
      plane.normal = random.turned(best.plane.normal, options_.refinement_angle * scale);
      if (!in_range(plane.depth) || !(plane.normal.dot(pixel.ray.direction) < -0.05f)) continue;
      const float cost = matcher_.score_best(pixel, plane, best.views,
                                             static_cast<std::size_t>(options_.refinement_views)) *
                         smoothness(around, plane, pixel.ray.at(plane.depth));
      if (cost < best.cost) {
        best.plane = plane;
        best.cost = cost;
        scale *= 0.5f;
      }
    }
  }

  // A hopeless pixel tries random planes, without the neighbours' say.
  bool restart(const ReferencePixel& pixel, KeyedRandom& random, Best& best) const {
    for (int trial = 0; trial < options_.refinement_trials; ++trial) {
      const PlaneHypothesis plane = random_plane(pixel, random);
      ViewCosts views;
      const float cost = matcher_.score_all(pixel, plane, views);
      if (cost < best.cost) best = {plane, cost, views};
    }
    return best.cost < options_.bad_cost;
  }

  const Matcher<Camera, Warp>& matcher_;
  PlaneMap& map_;
  const PatchMatchOptions& options_;
  SweepInput input_;
  std::vector<PlanePixel> edges_;  // rows above and below each inner strip edge, before the sweep
};

}  // namespace axial::depth
