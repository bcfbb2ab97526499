// SPDX-License-Identifier: GPL-3.0-or-later
// A SIMD register of floats with the operators of a number, based on std::experimental::simd. The
// ABI, and with it the instruction set, is a part of the type. Therefore functions that are
// compiled for different instruction sets have different names for the linker.
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

// The result of a comparison: one bool per lane.
template <class Abi>
struct PackMask {
  stdx::simd_mask<float, Abi> part;

  friend PackMask operator&&(const PackMask& a, const PackMask& b) { return {a.part && b.part}; }
  friend PackMask operator!(const PackMask& a) { return {!a.part}; }
};

// kWidth floats in one register. All operators work lane by lane. A default Pack has undefined
// values.
template <class Abi>
struct Pack {
  using Part = stdx::simd<float, Abi>;
  using Ints = stdx::rebind_simd_t<std::int32_t, Part>;
  static constexpr std::size_t kWidth = Part::size();
  static_assert(kLanes % kWidth == 0);

  Part part;

  Pack() = default;
  template <class Number>
  requires std::is_arithmetic_v<Number> Pack(Number value)  // `value` in every lane
      : part(static_cast<float>(value)) {}

  explicit Pack(const Part& lanes) : part(lanes) {}

  // load() reads and store() writes kWidth floats. The pointers must be aligned to the size of the
  // register.
  static Pack load(const float* aligned) {
    Pack pack;
    pack.part.copy_from(aligned, stdx::vector_aligned);
    return pack;
  }
  void store(float* aligned) const { part.copy_to(aligned, stdx::vector_aligned); }

  Pack& operator+=(const Pack& b) { return *this = *this + b; }
  Pack& operator-=(const Pack& b) { return *this = *this - b; }
  Pack& operator*=(const Pack& b) { return *this = *this * b; }

  friend Pack operator-(Pack a) {
    a.part = -a.part;
    return a;
  }
  friend Pack operator+(Pack a, const Pack& b) {
    a.part += b.part;
    return a;
  }
  friend Pack operator-(Pack a, const Pack& b) {
    a.part -= b.part;
    return a;
  }
  friend Pack operator*(Pack a, const Pack& b) {
    a.part *= b.part;
    return a;
  }
  friend Pack operator/(Pack a, const Pack& b) {
    a.part /= b.part;
    return a;
  }

  friend PackMask<Abi> operator<(const Pack& a, const Pack& b) { return {a.part < b.part}; }
  friend PackMask<Abi> operator<=(const Pack& a, const Pack& b) { return {a.part <= b.part}; }
  friend PackMask<Abi> operator>(const Pack& a, const Pack& b) { return {a.part > b.part}; }
  friend PackMask<Abi> operator>=(const Pack& a, const Pack& b) { return {a.part >= b.part}; }
};

// Returns `yes` in the lanes where `mask` is true and `no` in the other lanes. Always inlined, so
// that no two translation units share a compiled copy, not even two units for the same instruction
// set (tests/depth/shared_names_test.py). AVX-512 needs its own instruction: under clang,
// stdx::where of libstdc++ 12 takes all lanes from one of its two operands.
template <class Abi>
[[gnu::always_inline]] inline stdx::simd<float, Abi> blend(const stdx::simd_mask<float, Abi>& mask,
                                                           const stdx::simd<float, Abi>& yes,
                                                           stdx::simd<float, Abi> no) {
#ifdef __AVX512F__
  using Part = stdx::simd<float, Abi>;
  if constexpr (Part::size() == 16)
    return Part(_mm512_mask_blend_ps(static_cast<__mmask16>(mask.__to_bitset().to_ulong()),
                                     static_cast<__m512>(no), static_cast<__m512>(yes)));
  else if constexpr (Part::size() == 8)
    return Part(_mm256_mask_blend_ps(static_cast<__mmask8>(mask.__to_bitset().to_ulong()),
                                     static_cast<__m256>(no), static_cast<__m256>(yes)));
  else
#endif
  {
    stdx::where(mask, no) = yes;
    return no;
  }
}

// The same for packs.
template <class Abi>
[[gnu::always_inline]] inline Pack<Abi> select(const PackMask<Abi>& mask, const Pack<Abi>& yes,
                                               const Pack<Abi>& no) {
  return Pack<Abi>(blend(mask.part, yes.part, no.part));
}

// The square root and the absolute value of each lane.
template <class Abi>
Pack<Abi> sqrt(Pack<Abi> a) {
  a.part = stdx::sqrt(a.part);
  return a;
}

template <class Abi>
Pack<Abi> abs(Pack<Abi> a) {
  a.part = stdx::abs(a.part);
  return a;
}

// lesser() returns the smaller number of each lane, and greater() the larger number. Both return b
// if a or b is NaN, as the minimum and maximum instructions do. These instructions are faster than
// a comparison and a selection, as in min() and max().
template <class Abi>
Pack<Abi> lesser(const Pack<Abi>& a, const Pack<Abi>& b) {
  using Part [[maybe_unused]] = typename Pack<Abi>::Part;
#ifdef __AVX512F__
  if constexpr (Part::size() == 16)
    return Pack<Abi>(Part(_mm512_min_ps(static_cast<__m512>(a.part), static_cast<__m512>(b.part))));
#endif
#ifdef __AVX2__
  if constexpr (Part::size() == 8)
    return Pack<Abi>(Part(_mm256_min_ps(static_cast<__m256>(a.part), static_cast<__m256>(b.part))));
#endif
  return select(a < b, a, b);
}

template <class Abi>
Pack<Abi> greater(const Pack<Abi>& a, const Pack<Abi>& b) {
  using Part [[maybe_unused]] = typename Pack<Abi>::Part;
#ifdef __AVX512F__
  if constexpr (Part::size() == 16)
    return Pack<Abi>(Part(_mm512_max_ps(static_cast<__m512>(a.part), static_cast<__m512>(b.part))));
#endif
#ifdef __AVX2__
  if constexpr (Part::size() == 8)
    return Pack<Abi>(Part(_mm256_max_ps(static_cast<__m256>(a.part), static_cast<__m256>(b.part))));
#endif
  return select(a > b, a, b);
}

// min() returns the smaller number of each lane, and max() the larger number. Both return a if a or
// b is NaN.
template <class Abi>
Pack<Abi> min(const Pack<Abi>& a, const Pack<Abi>& b) {
  return select(b < a, b, a);
}

template <class Abi>
Pack<Abi> max(const Pack<Abi>& a, const Pack<Abi>& b) {
  return select(a < b, b, a);
}

// Table lookup: lane k of the result is table[aligned[k]]. `aligned`: one index per lane, from 0 to
// kLanes - 1. The array must outlive the object and be aligned to the size of the register. `table`
// has kLanes entries and is aligned to 64 bytes.
template <class Abi>
class Lookup {
 public:
  using Part = stdx::simd<float, Abi>;

  explicit Lookup(const std::int32_t* aligned) : index_(aligned) {}

  Pack<Abi> operator()(const float* table) const {
    Pack<Abi> pack;
    pack.part = part(table);
    return pack;
  }

 private:
  Part part(const float* table) const {
#ifdef __AVX512F__
    if constexpr (Part::size() == 16)
      return Part(static_cast<__m512>(
          _mm512_permutexvar_ps(_mm512_load_si512(index_), _mm512_load_ps(table))));
    else if constexpr (Part::size() == 8)
      return Part(static_cast<__m256>(_mm256_permutex2var_ps(
          _mm256_load_ps(table), _mm256_load_si256(reinterpret_cast<const __m256i*>(index_)),
          _mm256_load_ps(table + 8))));
    else
#elif defined(__AVX2__)
    if constexpr (Part::size() == 8) {
      const __m256i at = _mm256_load_si256(reinterpret_cast<const __m256i*>(index_));
      const __m256 low = _mm256_permutevar8x32_ps(_mm256_load_ps(table), at);
      const __m256 high = _mm256_permutevar8x32_ps(_mm256_load_ps(table + 8), at);
      return Part(_mm256_blendv_ps(low, high, _mm256_castsi256_ps(_mm256_slli_epi32(at, 28))));
    } else
#endif
      return Part([&](auto k) { return table[index_[k]]; });
  }

  const std::int32_t* index_;
};

}  // namespace axial::depth::lanes

namespace axial::refractive {
// Cameras of packs project with a fixed number of solver steps (refractive/scalar.h).
template <class Abi>
inline constexpr bool kFixedSteps<depth::lanes::Pack<Abi>> = true;
}  // namespace axial::refractive

// The properties that Eigen requires of a scalar type.
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
