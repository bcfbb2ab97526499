// SPDX-License-Identifier: GPL-3.0-or-later
// The state of PatchMatch: one plane hypothesis per pixel of the reference view.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "base/huge_pages.h"

namespace axial::depth {

// The surface at a pixel: a plane that meets the pixel's ray at distance `depth` (lambda of eq. 4).
// The normal has unit length, is in the reference camera's frame and faces the camera
// (normal . direction < 0).
struct PlaneHypothesis {
  float depth = 0;  // [m]; 0: no hypothesis
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
};

inline constexpr std::uint8_t kNoView = 255;  // in place of the index of a source view: none

// The indices of the two source views in which a plane has the lowest costs, best first. Both
// entries are one view if the plane was scored in one view only. Both are kNoView if the best views
// are not known.
using BestViews = std::array<std::uint8_t, 2>;

// The state of one pixel.
struct PlanePixel {
  PlaneHypothesis plane;
  // Surface point of the plane on the pixel's ray [reference camera's frame, m].
  Eigen::Vector3f point = Eigen::Vector3f::Zero();
  float cost = 2;  // of the plane, 0 (perfect) to 2; 2 if it is not known
  BestViews views{kNoView, kNoView};
  // Motion of the point in the best view per metre of depth [px/m]; 0: unknown or not visible.
  float motion = 0;
};

// The states of all pixels of an image. A new map has no hypotheses.
struct PlaneMap {
  int width = 0;
  int height = 0;
  std::vector<PlanePixel, HugePageAllocator<PlanePixel>> pixels;  // row-major

  PlaneMap() = default;
  PlaneMap(int w, int h)
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}

  // The index of pixel (x, y) in `pixels`. Precondition of index() and at(): (x, y) lies inside the
  // map.
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  PlanePixel& at(int x, int y) { return pixels[index(x, y)]; }
  const PlanePixel& at(int x, int y) const { return pixels[index(x, y)]; }
};

}  // namespace axial::depth
