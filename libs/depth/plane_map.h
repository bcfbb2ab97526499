// SPDX-License-Identifier: GPL-3.0-or-later
// The state of PatchMatch: one plane hypothesis per pixel of the reference view.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "base/huge_pages.h"

namespace axial::depth {

// The surface near a pixel: it meets the pixel's ray at distance `depth` (eq. 4) and has this
// normal, unit, in the reference camera's frame, facing the camera (normal . direction < 0).
struct PlaneHypothesis {
  float depth = 0;  // 0: none
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
};

inline constexpr std::uint8_t kNoView = 255;

// The two source views that see a plane best, best first; the same one twice where there is but
// one, kNoView where that is not known.
using BestViews = std::array<std::uint8_t, 2>;

struct PlanePixel {
  PlaneHypothesis plane;
  Eigen::Vector3f point = Eigen::Vector3f::Zero();  // origin + depth * direction
  float cost = 2;                                   // aggregated, 0 (perfect) to 2
  BestViews views{kNoView, kNoView};
  float motion = 0;  // of its image in the best view with depth [px/m]; 0: not known, or unseen
};

struct PlaneMap {
  int width = 0;
  int height = 0;
  std::vector<PlanePixel, HugePageAllocator<PlanePixel>> pixels;  // row-major

  PlaneMap() = default;
  PlaneMap(int w, int h)
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  PlanePixel& at(int x, int y) { return pixels[index(x, y)]; }
  const PlanePixel& at(int x, int y) const { return pixels[index(x, y)]; }
};

}  // namespace axial::depth
