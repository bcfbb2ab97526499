// SPDX-License-Identifier: GPL-3.0-or-later
// This file is compiled for AVX2. It must share no inline code with other translation units, which
// run on older processors too.
#include <immintrin.h>

#include "simulate/noise_corners.h"

namespace axial::simulate::detail {
namespace {

inline __m256i word(std::uint32_t value) {
  return _mm256_set1_epi32(static_cast<int>(value));
}

// `upper` for the corners whose number has the bit of the axis set, `lower` for the others.
inline __m256i by_corner(int axis, std::uint32_t lower, std::uint32_t upper) {
  const __m256i bits = _mm256_set_epi32(7, 6, 5, 4, 3, 2, 1, 0);
  const __m256i bit = _mm256_set1_epi32(1 << axis);
  const __m256i set = _mm256_cmpeq_epi32(_mm256_and_si256(bits, bit), bit);
  return _mm256_blendv_epi8(word(lower), word(upper), set);
}

inline __m256 by_corner(int axis, float lower, float upper) {
  const __m256i bits = _mm256_set_epi32(7, 6, 5, 4, 3, 2, 1, 0);
  const __m256i bit = _mm256_set1_epi32(1 << axis);
  const __m256i set = _mm256_cmpeq_epi32(_mm256_and_si256(bits, bit), bit);
  return _mm256_blendv_ps(_mm256_set1_ps(lower), _mm256_set1_ps(upper), _mm256_castsi256_ps(set));
}

inline __m256i lattice_hash(__m256i h) {
  h = _mm256_xor_si256(h, _mm256_srli_epi32(h, 16));
  h = _mm256_mullo_epi32(h, word(kHashFactors[0]));
  h = _mm256_xor_si256(h, _mm256_srli_epi32(h, 15));
  h = _mm256_mullo_epi32(h, word(kHashFactors[1]));
  return _mm256_xor_si256(h, _mm256_srli_epi32(h, 16));
}

inline __m256 component(__m256i h, int shift) {
  const __m256i bits = _mm256_and_si256(_mm256_srli_epi32(h, shift), word(1023));
  const __m256 scaled = _mm256_mul_ps(_mm256_cvtepi32_ps(bits), _mm256_set1_ps(kGradientStep));
  return _mm256_sub_ps(scaled, _mm256_set1_ps(1.0f));
}

}  // namespace

std::array<float, 8> corners_avx2(const NoiseCell& cell) {
  __m256i key = word(cell.seed);
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint32_t hash = cell.hash[static_cast<unsigned>(axis)];
    const std::uint32_t step = kHashSteps[static_cast<unsigned>(axis)];
    key = _mm256_xor_si256(key, by_corner(axis, hash, hash + step));
  }
  const __m256i h = lattice_hash(key);
  const auto part = [&](int axis) {
    const float offset = cell.offset[static_cast<unsigned>(axis)];
    return _mm256_mul_ps(component(h, 10 * axis), by_corner(axis, offset, offset - 1.0f));
  };
  alignas(32) std::array<float, 8> values;
  _mm256_store_ps(values.data(), _mm256_add_ps(_mm256_add_ps(part(0), part(1)), part(2)));
  return values;
}

}  // namespace axial::simulate::detail
