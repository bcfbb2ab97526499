// SPDX-License-Identifier: GPL-3.0-or-later
// The arguments and results of a scorer (scorer.h) as plain numbers. Only these types are passed
// between code compiled for different instruction sets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace axial::depth {
struct ReferencePatch;
}

namespace axial::depth::lanes {

// Largest number of pairs of a plane hypothesis and a source view that are scored at once.
inline constexpr std::size_t kLanes = 16;

// Largest side of a source image [px], because columns and rows are signed 16-bit numbers.
inline constexpr int kLargestSide = 32767;

// kLanes numbers in memory, aligned for every SIMD register.
struct alignas(64) LaneFloats : std::array<float, kLanes> {};

// Up to kLanes plane hypotheses of one reference pixel: depths along its ray [m], and unit normals
// in the reference camera's frame.
struct LanePlanes {
  LaneFloats depth;
  LaneFloats nx;
  LaneFloats ny;
  LaneFloats nz;
};

// The plane and the source view of each lane, as indices into LanePlanes and SceneTables. Lanes
// from `count` on are unused. The indices of unused lanes must be valid, too, so they repeat the
// indices of a used lane. The scores of unused lanes have no meaning.
struct LanePairs {
  std::size_t count;
  alignas(64) std::array<std::int32_t, kLanes> plane;
  alignas(64) std::array<std::int32_t, kLanes> view;
};

// The reference pixel. Its ray and the ray's derivatives by the pixel (u, v) are in the reference
// camera's frame.
struct LanePixel {
  std::array<float, 3> origin, direction;  // [m], unit vector
  std::array<float, 3> origin_u, origin_v, direction_u, direction_v;
  float prior_depth, prior_weight;  // [m], 0 to 1; prior_weight 0: no prior (PlaneScore::cost)
  const ReferencePatch* patch;      // the pixel's window
};

// The rays of kLanes pixels of a row, with their derivatives. Each of the 18 entries holds one
// component for all pixels. The components have the order of LanePixel: origin, direction,
// origin_u, origin_v, direction_u, direction_v.
struct LaneRays : std::array<LaneFloats, 18> {};

// The scores of the pairs. PlaneScore (matcher.h) explains them.
struct LaneScores {
  LaneFloats cost;        // 0 to kMaxCost
  LaneFloats motion;      // [px/m]; 0: not visible
  LaneFloats smoothness;  // factor of the lane's plane (smoothness.h)
};

}  // namespace axial::depth::lanes
