// SPDX-License-Identifier: BSD-3-Clause
// The operations that the cameras need from a scalar type besides arithmetic. With these
// operations, one implementation serves float, double, automatic-differentiation scalars and SIMD
// packs. A SIMD pack has to define the mask type that its comparisons return, with the operator &&.
// The pack also has to overload `select`, `lesser`, `greater`, `sqrt` and `abs` in its own
// namespace.
#pragma once

#include <type_traits>
#include <utility>

namespace axial::refractive {

// The type of the result of a comparison: bool for plain scalars, a mask for SIMD packs.
template <class T>
using Mask = std::decay_t<decltype(std::declval<const T&>() < std::declval<const T&>())>;

// `yes` if `condition` is true, otherwise `no`. For a SIMD pack: chosen lane by lane.
template <class T>
T select(bool condition, const T& yes, const T& no) {
  return condition ? yes : no;
}

// The smaller and the larger of two numbers. Both functions return b if a or b is NaN.
template <class T>
T lesser(const T& a, const T& b) {
  return a < b ? a : b;
}
template <class T>
T greater(const T& a, const T& b) {
  return a > b ? a : b;
}

// True if projections take a fixed number of solver steps and do not branch. True for float; a SIMD
// pack of floats must specialise this constant to true. False for all other scalars: their
// projections iterate to convergence.
template <class T>
inline constexpr bool kFixedSteps = std::is_same_v<T, float>;

}  // namespace axial::refractive
