// SPDX-License-Identifier: GPL-3.0-or-later
// Bilinear grey levels in integer arithmetic, with one position per SIMD lane. Positions are
// 16.16 fixed-point numbers. Weights have 15 bits. The 16-bit halves of a 32-bit lane hold the
// upper and the lower row of the 2x2 neighbourhood. Integer arithmetic needs half the work of
// floats. Its results are exact to 0.01 grey levels, and are bit-identical on all instruction
// sets.
#pragma once

#include "depth/lanes/pack.h"

namespace axial::depth::lanes {

inline constexpr float kPositionUnit = 65536;          // the integer for 1 px
inline constexpr float kGreyUnit = 128.0f * 32767.0f;  // the integer for 1 grey level

namespace detail {

#ifdef __AVX2__
// Loads base[at] with eight scalar loads. On AMD's Zen 3 and Zen 4, scalar loads are faster than
// the gather instruction, which these processors execute as microcode.
[[gnu::always_inline]] inline __m256i gather_by_loads(const int* base, __m256i at) {
  const auto four_of = [&](std::uint64_t first, std::uint64_t second) {
    __m128i words = _mm_cvtsi32_si128(base[static_cast<std::uint32_t>(first)]);
    words = _mm_insert_epi32(words, base[first >> 32], 1);
    words = _mm_insert_epi32(words, base[static_cast<std::uint32_t>(second)], 2);
    return _mm_insert_epi32(words, base[second >> 32], 3);
  };
  const auto half = [&](__m128i four) {
    return four_of(static_cast<std::uint64_t>(_mm_cvtsi128_si64(four)),
                   static_cast<std::uint64_t>(_mm_extract_epi64(four, 1)));
  };
  const __m128i low = half(_mm256_castsi256_si128(at));
  return _mm256_inserti128_si256(_mm256_castsi128_si256(low), half(_mm256_extracti128_si256(at, 1)),
                                 1);
}
#endif

// base[at] for each lane. Precondition: no index is negative.
template <class Abi>
auto gather(const std::uint32_t* base, const typename Pack<Abi>::Ints& at) {
  using Ints = typename Pack<Abi>::Ints;
  const auto* ints = reinterpret_cast<const int*>(base);
#ifdef __AVX2__
  if constexpr (Ints::size() == 8)
    return Ints(gather_by_loads(ints, static_cast<__m256i>(at)));
  else
#endif
    return Ints([&](auto k) { return ints[at[k]]; });
}

#ifdef __AVX2__
// Shuffle mask: copies the lower half of each of four 32-bit lanes to both halves.
inline __m128i lower_half_twice() {
  return _mm_setr_epi8(0, 1, 0, 1, 4, 5, 4, 5, 8, 9, 8, 9, 12, 13, 12, 13);
}
#endif

// Operations on the signed 16-bit halves of 32-bit lanes.
//   upper_bytes:     each half shifted right by 8 bits.
//   times_128, add_halves, subtract_halves: the result of each half.
//   multiply_halves: the product of each pair of halves, divided by 2^15 and rounded.
//   dot_halves:      the sum of the products of the upper halves and of the lower halves, 32 bits.
//   upper_halves:    upper half of the result: the upper half of `upper`; lower half of the result:
//                    the upper half of `lower`.
//   fractions:       the upper 15 bits of the fraction of a 16.16 number, in both halves.
#ifdef __AVX2__
inline __m256i upper_bytes(__m256i a) {
  return _mm256_srli_epi16(a, 8);
}
inline __m256i times_128(__m256i a) {
  return _mm256_slli_epi16(a, 7);
}
inline __m256i add_halves(__m256i a, __m256i b) {
  return _mm256_add_epi16(a, b);
}
inline __m256i subtract_halves(__m256i a, __m256i b) {
  return _mm256_sub_epi16(a, b);
}
inline __m256i multiply_halves(__m256i a, __m256i b) {
  return _mm256_mulhrs_epi16(a, b);
}
inline __m256i dot_halves(__m256i a, __m256i b) {
  return _mm256_madd_epi16(a, b);
}
inline __m256i upper_halves(__m256i upper, __m256i lower) {
  return _mm256_blend_epi16(_mm256_srli_epi32(lower, 16), upper, 0xAA);
}
inline __m256i fractions(__m256i a) {
  return _mm256_srli_epi16(_mm256_shuffle_epi8(a, _mm256_broadcastsi128_si256(lower_half_twice())),
                           1);
}
#endif

}  // namespace detail

// Samples the source image of each lane.
template <class Abi>
class LaneSampler {
 public:
  using Part = typename Pack<Abi>::Part;
  using Ints = typename Pack<Abi>::Ints;

  // `words`: SceneTables::words, which must outlive the sampler. `begin`: the index of the first
  // word of each lane's image. `width`: the width of each lane's image [px].
  LaneSampler(const std::uint32_t* words, const Ints& begin, const Ints& width)
      : words_(words), begin_(begin), width_(kHalves ? (width << 16) | Ints(1) : width) {}

  // Returns the grey level at (x, y), times kGreyUnit. x and y are in units of 1/kPositionUnit
  // px. Precondition: 0 <= x < width - 1 and 0 <= y < height - 1, in pixels.
  Part operator()(const Ints& x, const Ints& y) const {
    if constexpr (kHalves)
      return by_halves(x, y);
    else
      return by_lanes(x, y);
  }

 private:
  // Whether by_halves() is used, which needs AVX2 and registers of eight lanes.
#ifdef __AVX2__
  static constexpr bool kHalves = Ints::size() == 8;
  using Register = __m256i;
#else
  static constexpr bool kHalves = false;
#endif

  // Computes the result in whole 32-bit lanes.
  Part by_lanes(const Ints& x, const Ints& y) const {
    const Ints word = detail::gather<Abi>(words_, begin_ + (y >> 16) * width_ + (x >> 16));
    const Ints fx = (x >> 1) & Ints(0x7FFF), fy = (y >> 1) & Ints(0x7FFF);
    const Ints byte(0xFF);
    const Ints left = word & byte, right = (word >> 8) & byte;
    const Ints left_below = (word >> 16) & byte, right_below = (word >> 24) & byte;
    const auto between = [&](const Ints& a, const Ints& b) {
      return (a << 7) + ((((b - a) << 7) * fx + Ints(0x4000)) >> 15);
    };
    const Ints grey =
        between(left, right) * (Ints(0x7FFF) - fy) + between(left_below, right_below) * fy;
    return stdx::static_simd_cast<Part>(grey);
  }

  // Computes the result of by_lanes(), bit for bit, in 16-bit halves.
  Part by_halves(const Ints& x, const Ints& y) const {
#ifdef __AVX2__
    using namespace detail;
    const auto raw = [](const Ints& a) { return static_cast<Register>(a); };
    const Ints at = begin_ + Ints(dot_halves(upper_halves(raw(y), raw(x)), raw(width_)));
    const Register word = raw(gather<Abi>(words_, at));

    const Register fx = fractions(raw(x));
    const Register fy = raw(Ints(fractions(raw(y))) ^ Ints(0x7FFF));  // weights of both rows
    const Register left = raw(Ints(word) & Ints(0x00FF00FF));
    const Register step = times_128(subtract_halves(upper_bytes(word), left));
    const Register rows = add_halves(times_128(left), multiply_halves(step, fx));
    return stdx::static_simd_cast<Part>(Ints(dot_halves(rows, fy)));
#else
    return by_lanes(x, y);
#endif
  }

  const std::uint32_t* words_;
  Ints begin_;
  Ints width_;  // with kHalves: the width in the upper half, 1 in the lower half
};

}  // namespace axial::depth::lanes
