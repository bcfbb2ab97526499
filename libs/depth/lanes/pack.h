// SPDX-License-Identifier: GPL-3.0-or-later
// Sixteen floats that are computed with as one number, over std::experimental::simd. The ABI names
// the instruction set in the type, so that code compiled for different sets never shares a name.
#pragma once

#include <array>
#include <cstdint>
#include <experimental/simd>

#include "depth/lanes/request.h"
#include "refractive/scalar.h"

#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace axial::depth::lanes {

namespace stdx = std::experimental;

template <class Abi>
inline constexpr std::size_t kParts = kLanes / stdx::simd<float, Abi>::size();

// Yes or no in every lane.
template <class Abi>
struct PackMask {
  std::array<stdx::simd_mask<float, Abi>, kParts<Abi>> part;

  friend PackMask operator&&(PackMask a, const PackMask& b) {
    for (std::size_t i = 0; i < kParts<Abi>; ++i) a.part[i] = a.part[i] && b.part[i];
    return a;
  }
  friend PackMask operator!(PackMask a) {
    for (auto& part : a.part) part = !part;
    return a;
  }
};

template <class Abi>
struct Pack {
  using Part = stdx::simd<float, Abi>;
  using Ints = stdx::rebind_simd_t<std::int32_t, Part>;
  static constexpr std::size_t kWidth = Part::size();
  static constexpr std::size_t kCount = kParts<Abi>;

  std::array<Part, kCount> part;

  Pack() = default;
  template <class Number>
  requires std::is_arithmetic_v<Number> Pack(Number value) {  // the same in every lane
    for (Part& p : part) p = static_cast<float>(value);
  }

  static Pack load(const float* aligned) {
    Pack pack;
    for (std::size_t i = 0; i < kCount; ++i)
      pack.part[i].copy_from(aligned + i * kWidth, stdx::vector_aligned);
    return pack;
  }
  void store(float* aligned) const {
    for (std::size_t i = 0; i < kCount; ++i)
      part[i].copy_to(aligned + i * kWidth, stdx::vector_aligned);
  }

  Pack& operator+=(const Pack& b) { return *this = *this + b; }
  Pack& operator-=(const Pack& b) { return *this = *this - b; }
  Pack& operator*=(const Pack& b) { return *this = *this * b; }

  friend Pack operator-(Pack a) {
    for (Part& p : a.part) p = -p;
    return a;
  }
  friend Pack operator+(Pack a, const Pack& b) {
    for (std::size_t i = 0; i < kCount; ++i) a.part[i] += b.part[i];
    return a;
  }
  friend Pack operator-(Pack a, const Pack& b) {
    for (std::size_t i = 0; i < kCount; ++i) a.part[i] -= b.part[i];
    return a;
  }
  friend Pack operator*(Pack a, const Pack& b) {
    for (std::size_t i = 0; i < kCount; ++i) a.part[i] *= b.part[i];
    return a;
  }
  friend Pack operator/(Pack a, const Pack& b) {
    for (std::size_t i = 0; i < kCount; ++i) a.part[i] /= b.part[i];
    return a;
  }

  friend PackMask<Abi> operator<(const Pack& a, const Pack& b) {
    PackMask<Abi> mask;
    for (std::size_t i = 0; i < kCount; ++i) mask.part[i] = a.part[i] < b.part[i];
    return mask;
  }
  friend PackMask<Abi> operator<=(const Pack& a, const Pack& b) {
    PackMask<Abi> mask;
    for (std::size_t i = 0; i < kCount; ++i) mask.part[i] = a.part[i] <= b.part[i];
    return mask;
  }
  friend PackMask<Abi> operator>(const Pack& a, const Pack& b) { return b < a; }
  friend PackMask<Abi> operator>=(const Pack& a, const Pack& b) { return b <= a; }
};

template <class Abi>
Pack<Abi> select(const PackMask<Abi>& mask, const Pack<Abi>& yes, Pack<Abi> no) {
  for (std::size_t i = 0; i < kParts<Abi>; ++i) stdx::where(mask.part[i], no.part[i]) = yes.part[i];
  return no;
}

template <class Abi>
Pack<Abi> sqrt(Pack<Abi> a) {
  for (auto& p : a.part) p = stdx::sqrt(p);
  return a;
}

template <class Abi>
Pack<Abi> abs(Pack<Abi> a) {
  for (auto& p : a.part) p = stdx::abs(p);
  return a;
}

template <class Abi>
Pack<Abi> min(Pack<Abi> a, const Pack<Abi>& b) {
  return select(b < a, b, a);
}

template <class Abi>
Pack<Abi> max(Pack<Abi> a, const Pack<Abi>& b) {
  return select(a < b, b, a);
}

// Lane k of the result is table[index of lane k]; a table has one entry per lane.
template <class Abi>
struct Lookup {
  using Part = stdx::simd<float, Abi>;
  alignas(64) std::array<std::int32_t, kLanes> index;

  Pack<Abi> operator()(const float* aligned) const {
    Pack<Abi> pack;
    for (std::size_t i = 0; i < kParts<Abi>; ++i) pack.part[i] = part(aligned, i * Part::size());
    return pack;
  }

 private:
  Part part(const float* table, std::size_t first) const {
#ifdef __AVX512F__
    if constexpr (Part::size() == 16)
      return Part(static_cast<__m512>(
          _mm512_permutexvar_ps(_mm512_load_si512(index.data()), _mm512_load_ps(table))));
    else
#elif defined(__AVX2__)
    if constexpr (Part::size() == 8) {
      const __m256i at = _mm256_load_si256(reinterpret_cast<const __m256i*>(index.data() + first));
      const __m256 low = _mm256_permutevar8x32_ps(_mm256_load_ps(table), at);
      const __m256 high = _mm256_permutevar8x32_ps(_mm256_load_ps(table + 8), at);
      return Part(_mm256_blendv_ps(low, high, _mm256_castsi256_ps(_mm256_slli_epi32(at, 28))));
    } else
#endif
      return Part([&](auto k) { return table[index[first + k]]; });
  }
};

}  // namespace axial::depth::lanes

namespace axial::refractive {
template <class Abi>
inline constexpr bool kFixedSteps<depth::lanes::Pack<Abi>> = true;
}

// What Eigen wants to know of a number.
namespace Eigen {
template <class Abi>
struct NumTraits<axial::depth::lanes::Pack<Abi>>
    : GenericNumTraits<axial::depth::lanes::Pack<Abi>> {
  using Pack = axial::depth::lanes::Pack<Abi>;
  using Real = Pack;
  using NonInteger = Pack;
  using Nested = Pack;
  using Literal = float;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 0,
    ReadCost = 1,
    AddCost = 1,
    MulCost = 1
  };
};
}  // namespace Eigen
