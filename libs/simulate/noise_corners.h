// SPDX-License-Identifier: GPL-3.0-or-later
// The inner part of gradient noise, in which the rendering of an image spends most of its time: the
// contributions of the eight corners of a lattice cell to a point in it.
#pragma once

#include <array>
#include <cstdint>

namespace axial::simulate::detail {

struct NoiseCell {
  std::array<std::uint32_t, 3> hash;  // of the cell's lower corner, one for each axis
  std::array<float, 3> offset;        // of the point from that corner, 0 to 1
  std::uint32_t seed;
};

constexpr std::array<std::uint32_t, 3> kHashSteps{0x8da6b343u, 0xd8163841u, 0xcb1ab31fu};
constexpr std::array<std::uint32_t, 2> kHashFactors{0x7feb352du, 0x846ca68bu};
constexpr float kGradientStep = 1.0f / 511.5f;

// Computes for each corner the dot product of its gradient and the offset of the point from this
// corner. The components of gradients are uniform in [-1, 1]. Bits 0, 1 and 2 of the index of a
// corner tell whether it is the upper corner along x, y and z. All implementations give identical
// bits.
using CornersFunction = std::array<float, 8> (*)(const NoiseCell&);
std::array<float, 8> corners_scalar(const NoiseCell& cell);
std::array<float, 8> corners_avx2(const NoiseCell& cell);

// The fastest implementation that this processor can run.
CornersFunction fastest_corners();

}  // namespace axial::simulate::detail
