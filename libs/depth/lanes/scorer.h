// SPDX-License-Identifier: GPL-3.0-or-later
// Scores up to 16 pairs of a plane hypothesis and a source view at a time, with one pair per SIMD
// lane. Exact projection, its Jacobian, affine warp, ZNCC and geometric consistency all run in SIMD
// lanes. Every lane computes the same operations as scalar floats, in the same order and without
// fused multiply-add. So the results are bit-identical on all instruction sets.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/huge_pages.h"
#include "depth/lanes/request.h"
#include "depth/smoothness.h"

namespace axial::depth::lanes {

// The kinds of cameras that the SIMD code supports.
enum class CameraKind {
  pinhole,
  flat_port,
  dome_port,
  // The same kinds with a distorted lens.
  lens_pinhole,
  lens_flat_port,
  lens_dome_port
};

// Largest number of floats that describe a camera or its projector.
inline constexpr std::size_t kMaxCameraFields = 96;

// The numbers of a camera or of its projector (each_field() in refractive/axial_ray.h).
struct CameraFields {
  std::array<float, kMaxCameraFields> value{};  // in the order of each_field(), then 0
  int steps = 0;  // the only integer: the number of solver steps; 0 without a solver

  bool operator==(const CameraFields&) const = default;
};

// The data of the reference camera and of up to kLanes source views. Each LaneFloats below has one
// entry per source view. Entries after the last view are not used.
struct SceneTables {
  CameraKind kind = CameraKind::pinhole;  // of the source cameras; for rays(): of `reference`
  CameraFields reference;                 // used by rays() only
  // The projectors' fields: projector[field][view].
  std::array<LaneFloats, kMaxCameraFields> projector{};
  int steps = 0;                // largest number of solver steps of all projectors
  bool same_projector = false;  // the projectors of all source views are equal
  // The transformation from the reference camera's frame to the frame of each source view's
  // projector: x_projector = rotation * x_reference + translation. The rotation is row-major.
  std::array<LaneFloats, 9> rotation{};
  std::array<LaneFloats, 3> translation{};
  // words: the words of all source images (QuadImage, zncc.h), one image after the other.
  // image_begin: the index of each image's first word.
  std::vector<std::uint32_t, HugePageAllocator<std::uint32_t>> words;
  std::array<std::int32_t, kLanes> image_begin{};
  LaneFloats width{};   // of each image [px]
  LaneFloats height{};  // of each image [px]
  // depths: the depth maps of the source views [m], with the indices of `words`; empty if the cost
  // is only photometric. has_depth: 1 if the view has a depth map, otherwise 0.
  std::vector<float, HugePageAllocator<float>> depths;
  LaneFloats has_depth{};
  // The fields of PatchMatchOptions (options.h) with the same names.
  float geometric_weight = 0;
  float geometric_limit = 0;
  SmoothnessOptions smoothness;
};

// Scores pairs and computes rays for the cameras of a SceneTables. Several threads may use one
// scorer at the same time.
class Scorer {
 public:
  virtual ~Scorer();  // in scorer.cpp, so that no two instruction sets share it
  // Sets entry k of each array in `scores` for the pair k. `neighbours`: the surface at
  // neighbouring pixels, for the smoothness factor. Preconditions: pairs.plane are indices of valid
  // planes; pairs.view are below the number of views in the tables.
  virtual void score(const LanePixel& pixel, const LanePlanes& planes, const LanePairs& pairs,
                     std::span<const SurfacePoint> neighbours, LaneScores& scores) const = 0;
  // Sets `rays` to the rays of the reference camera's pixels (x, y) to (x + kLanes - 1, y). The
  // pixels may lie outside the image. Precondition: SceneTables::kind is the kind of the reference
  // camera.
  virtual void rays(float x, float y, LaneRays& rays) const = 0;
};

// scalar: one float at a time, the reference in the tests of the other sets. baseline: the
// instruction set for which the whole program is compiled. avx2, avx512: AVX2 and AVX-512.
enum class InstructionSet { scalar, baseline, avx2, avx512 };

// The instruction sets that this build and this processor support, the fastest set last. `scalar`
// and `baseline` are always supported.
std::vector<InstructionSet> available_instruction_sets();
InstructionSet fastest_instruction_set();  // the last of available_instruction_sets()

// Makes a scorer for the kind of camera in `tables`, which must outlive the scorer. Precondition:
// `set` is available.
std::unique_ptr<Scorer> make_scorer(const SceneTables& tables, InstructionSet set);

namespace detail {  // each function has its own translation unit

// Make a scorer for one instruction set. The functions with `lens` in their names support the kinds
// of cameras with a distorted lens, the others the kinds without. The result for another kind is
// nullptr. The functions for AVX2 and AVX-512 do not exist in builds with sanitizers.
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
