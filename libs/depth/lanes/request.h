// SPDX-License-Identifier: GPL-3.0-or-later
// What a lane scorer is asked, in plain numbers: this is all that crosses the border between code
// compiled for different instruction sets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace axial::depth {
struct ReferencePatch;
}

namespace axial::depth::lanes {

// Pairs of a plane hypothesis and a source view that are scored at once.
inline constexpr std::size_t kLanes = 16;

// Largest side of a source image [px]: columns and rows are signed 16-bit numbers.
inline constexpr int kLargestSide = 32767;

struct alignas(64) LaneFloats : std::array<float, kLanes> {};

// Up to kLanes plane hypotheses of one reference pixel.
struct LanePlanes {
  LaneFloats depth;
  LaneFloats nx;
  LaneFloats ny;
  LaneFloats nz;
};

// Which plane (of LanePlanes) and which source view a lane works on. All lanes must be valid:
// unused ones, those from `count` on, repeat another, and their scores mean nothing.
struct LanePairs {
  std::size_t count;
  alignas(64) std::array<std::int32_t, kLanes> plane;
  alignas(64) std::array<std::int32_t, kLanes> view;
};

// The reference pixel: its ray and the ray's derivatives by u and v, reference camera's frame.
struct LanePixel {
  std::array<float, 3> origin, direction;
  std::array<float, 3> origin_u, origin_v, direction_u, direction_v;
  float prior_depth, prior_weight;
  const ReferencePatch* patch;
};

// The rays of kLanes pixels of a row and their derivatives, component by component in the order of
// LanePixel.
struct LaneRays : std::array<LaneFloats, 18> {};

struct LaneScores {
  LaneFloats cost;        // 0 to kMaxCost
  LaneFloats motion;      // of the patch's centre in the source view with depth [px/m]; 0
                          // if unseen
  LaneFloats smoothness;  // factor of the lane's plane (smoothness.h)
};

}  // namespace axial::depth::lanes
