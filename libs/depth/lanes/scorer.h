// SPDX-License-Identifier: GPL-3.0-or-later
// Scores pairs of a plane hypothesis and a source view, sixteen at a time, one to a SIMD lane: the
// exact projection and its Jacobian, the affine warp, ZNCC and geometric consistency all run in
// lanes. Every lane computes what plain floats would, in the same order, without fused operations:
// the same bytes on every instruction set.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/huge_pages.h"
#include "depth/lanes/request.h"
#include "depth/smoothness.h"

namespace axial::depth::lanes {

enum class CameraKind {
  pinhole,
  flat_port,
  dome_port,
  // The same with a distorted lens.
  lens_pinhole,
  lens_flat_port,
  lens_dome_port
};

inline constexpr std::size_t kMaxCameraFields = 96;

// The numbers of a camera or its projector as its each_field() visits them.
struct CameraFields {
  std::array<float, kMaxCameraFields> value{};
  int steps = 0;  // the one int among them

  bool operator==(const CameraFields&) const = default;
};

// Everything about the reference camera and up to kLanes source views. Tables have one entry per
// view; those beyond the last view are never asked for.
struct SceneTables {
  CameraKind kind = CameraKind::pinhole;
  CameraFields reference;
  std::array<LaneFloats, kMaxCameraFields> projector{};
  int steps = 0;                // largest of the projectors'
  bool same_projector = false;  // all source views have the first one's
  // x_projector = rotation * x_reference + translation, in the source projector's frame; row-major.
  std::array<LaneFloats, 9> rotation{};
  std::array<LaneFloats, 3> translation{};
  // Quad words (zncc.h) of all source images in one run, and where each begins.
  std::vector<std::uint32_t, HugePageAllocator<std::uint32_t>> words;
  std::array<std::int32_t, kLanes> image_begin{};
  LaneFloats width{};
  LaneFloats height{};
  // The source views' depth maps, as `words`; empty: photometric only. has_depth is 0 or 1.
  std::vector<float, HugePageAllocator<float>> depths;
  LaneFloats has_depth{};
  float geometric_weight = 0;
  float geometric_limit = 0;
  SmoothnessOptions smoothness;
};

// Precondition of all: indices of views are below the number of views in the tables.
class Scorer {
 public:
  virtual ~Scorer() = default;
  // Fills `scores` for every pair. `neighbours`: the surface around the pixel.
  virtual void score(const LanePixel& pixel, const LanePlanes& planes, const LanePairs& pairs,
                     std::span<const SurfacePoint> neighbours, LaneScores& scores) const = 0;
  // Of the reference camera's pixels from (x, y) on.
  virtual void rays(float x, float y, LaneRays& rays) const = 0;
};

enum class InstructionSet { scalar, baseline, avx2, avx512 };

// What this processor can run; `scalar` is the reference that the others are tested against.
std::vector<InstructionSet> available_instruction_sets();
InstructionSet fastest_instruction_set();

// `tables` must outlive the scorer. Precondition: `set` is available.
std::unique_ptr<Scorer> make_scorer(const SceneTables& tables, InstructionSet set);

namespace detail {  // one translation unit each, for straight lenses and for distorted ones
std::unique_ptr<Scorer> make_scalar_scorer(const SceneTables& tables);
std::unique_ptr<Scorer> make_baseline_scorer(const SceneTables& tables);
std::unique_ptr<Scorer> make_avx2_scorer(const SceneTables& tables);
std::unique_ptr<Scorer> make_avx512_scorer(const SceneTables& tables);
std::unique_ptr<Scorer> make_scalar_lens_scorer(const SceneTables& tables);
std::unique_ptr<Scorer> make_baseline_lens_scorer(const SceneTables& tables);
std::unique_ptr<Scorer> make_avx2_lens_scorer(const SceneTables& tables);
std::unique_ptr<Scorer> make_avx512_lens_scorer(const SceneTables& tables);
}  // namespace detail

}  // namespace axial::depth::lanes
