// SPDX-License-Identifier: GPL-3.0-or-later
// The inner part of gradient noise: the contributions of the eight corners of a lattice cell to a
// point in the cell. The rendering of an image spends most of its time here.
#pragma once

#include <array>
#include <cstdint>

namespace axial::simulate::detail {

// A point in a cell of the lattice. The cell's lower corner has the smallest x, y and z.
struct NoiseCell {
  // For each axis, the integer coordinate of the cell's lower corner times kHashSteps (modulo
  // 2^32).
  std::array<std::uint32_t, 3> hash;
  std::array<float, 3> offset;  // the point minus the cell's lower corner, 0 to 1
  std::uint32_t seed;           // of gradient_noise()
};

// The constants from which all implementations compute the gradients: factors of the corners'
// coordinates, factors of the hash function, and the distance of two neighbouring values of a
// gradient's component.
constexpr std::array<std::uint32_t, 3> kHashSteps{0x8da6b343u, 0xd8163841u, 0xcb1ab31fu};
constexpr std::array<std::uint32_t, 2> kHashFactors{0x7feb352du, 0x846ca68bu};
constexpr float kGradientStep = 1.0f / 511.5f;

// Computes for each corner the dot product of the corner's gradient and the offset of the point
// from the corner. The components of gradients are uniform in [-1, 1]. In the result, bits 0, 1 and
// 2 of the index of a corner are set if the corner is the upper one along x, y and z. All
// implementations return the same bits. Precondition of corners_avx2(): the processor has AVX2.
using CornersFunction = std::array<float, 8> (*)(const NoiseCell&);
std::array<float, 8> corners_scalar(const NoiseCell& cell);
std::array<float, 8> corners_avx2(const NoiseCell& cell);

// The fastest implementation that this processor can run.
CornersFunction fastest_corners();

}  // namespace axial::simulate::detail
