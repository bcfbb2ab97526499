// SPDX-License-Identifier: GPL-3.0-or-later
// The scorer as a template for all instruction sets. Only the scorers' translation units include
// this file. Each of these translation units is compiled for one instruction set.
#pragma once

#include "depth/lanes/lane_view.h"
#include "depth/lanes/lane_zncc.h"
#include "refractive/dome_port_camera.h"
#include "refractive/flat_port_camera.h"
#include "refractive/pinhole_camera.h"

// AXIAL_FLATTEN inlines all calls of a function, so that values stay in registers. It is empty
// under the sanitizers, where the large function would take minutes to compile.
#ifdef AXIAL_SANITIZED
#define AXIAL_FLATTEN
#else
#define AXIAL_FLATTEN [[gnu::flatten]]
#endif

namespace axial::depth::lanes {

// A scorer for one kind of camera. `Camera`: the template of the camera type, with the scalar as
// its argument. `Narrow` and `Wide`: ABIs of std::experimental::simd, which may be equal. `tables`
// must outlive the scorer.
//
// Projects in registers of `Wide` and correlates in registers of `Narrow`. A projection is a long
// chain of dependent operations. Two narrow registers need two passes through this chain, but one
// wide register needs only one pass, which takes no longer if half of the register is unused.
// Correlation is not faster with wide registers, because texels are loaded one by one.
template <template <class> class Camera, class Narrow, class Wide>
class LaneScorer final : public Scorer {
  using T = Pack<Narrow>;
  using View = LaneView<Camera, Wide>;

 public:
  explicit LaneScorer(const SceneTables& tables) : tables_(tables), view_(tables) {}

  // Projects all pairs before it correlates any, so that the processor can overlap the dependent
  // operations of several registers.
  AXIAL_FLATTEN void score(const LanePixel& pixel, const LanePlanes& planes, const LanePairs& pairs,
                           std::span<const SurfacePoint> neighbours,
                           LaneScores& scores) const override {
    LaneProjections projected;
    for (std::size_t first = 0; first < pairs.count; first += View::kWidth)
      view_.look(pixel, planes, pairs, neighbours, first, scores, projected);
    for (std::size_t first = 0; first < pairs.count; first += T::kWidth)
      compare(pixel, pairs, projected, first, scores);
  }

  AXIAL_FLATTEN void rays(float x, float y, LaneRays& rays) const override {
    for (std::size_t first = 0; first < kLanes; first += View::kWidth)
      view_.rays(x + static_cast<float>(first), y, first, rays);
  }

 private:
  // Stores the costs of T::kWidth pairs, from pair `first` on.
  void compare(const LanePixel& pixel, const LanePairs& pairs, const LaneProjections& projected,
               std::size_t first, LaneScores& scores) const {
    const auto at = [&](const LaneFloats& floats) { return T::load(floats.data() + first); };
    refractive::Matrix2<T> warp;
    warp << at(projected.warp[0]), at(projected.warp[1]), at(projected.warp[2]),
        at(projected.warp[3]);
    const refractive::Projection<T> centre{{at(projected.x), at(projected.y)},
                                           at(projected.visible) > T(0)};
    const T correlation =
        lane_zncc(*pixel.patch, tables_.words.data(),
                  lane_images<Narrow>(tables_, pairs.view.data() + first), centre, warp);
    T cost = select(correlation < T(-1.5f), T(kOutsideCost), T(1) - correlation);
    cost += at(projected.inconsistency);
    if (pixel.prior_weight > 0) {
      const T off = abs(at(projected.depth) - T(pixel.prior_depth)) / T(pixel.prior_depth);
      cost += T(pixel.prior_weight) * (min(off, T(0.5f)) - cost);
    }
    min(cost, T(kMaxCost)).store(scores.cost.data() + first);
  }

  const SceneTables& tables_;
  View view_;
};

// Makes a scorer for the kind of camera in `tables`, which must outlive the scorer. Returns nullptr
// if this kind has a distorted lens. Narrow, Wide: see LaneScorer.
template <class Narrow, class Wide = Narrow>
std::unique_ptr<Scorer> make_lane_scorer(const SceneTables& tables) {
  switch (tables.kind) {
    case CameraKind::pinhole:
      return std::make_unique<LaneScorer<refractive::PinholeCamera, Narrow, Wide>>(tables);
    case CameraKind::flat_port:
      return std::make_unique<LaneScorer<refractive::FlatPortCamera, Narrow, Wide>>(tables);
    case CameraKind::dome_port:
      return std::make_unique<LaneScorer<refractive::DomePortCamera, Narrow, Wide>>(tables);
    default:
      return nullptr;
  }
}

}  // namespace axial::depth::lanes
