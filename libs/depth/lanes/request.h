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

struct alignas(64) LaneFloats : std::array<float, kLanes> {};

// Up to kLanes plane hypotheses of one reference pixel.
struct LanePlanes {
  LaneFloats depth;
  LaneFloats nx;
  LaneFloats ny;
  LaneFloats nz;
};

// Which plane (of LanePlanes) and which source view a lane works on. All lanes must be valid:
// unused ones repeat another.
struct LanePairs {
  alignas(64) std::array<std::int32_t, kLanes> plane;
  alignas(64) std::array<std::int32_t, kLanes> view;
};

// The reference pixel: its ray and the ray's derivatives by u and v, reference camera's frame.
struct LanePixel {
  std::array<float, 3> origin, direction;
  std::array<float, 3> origin_u, origin_v, direction_u, direction_v;
  std::array<float, 2> at;
  float prior_depth, prior_weight;
  const ReferencePatch* patch;
};

struct LaneScores {
  LaneFloats cost;    // 0 to kMaxCost
  LaneFloats motion;  // of the patch's centre in the source view with depth [px/m]; 0
                      // if unseen
};

}  // namespace axial::depth::lanes
