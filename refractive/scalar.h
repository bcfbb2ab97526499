// SPDX-License-Identifier: GPL-3.0-or-later
// What the cameras ask of a scalar beyond arithmetic, so that one implementation serves float,
// double, automatic differentiation and SIMD packs. A pack of lanes brings its own mask type (the
// result of comparing), with &&, || and !, and overloads of `select`, `lesser`, `greater` and
// `sqrt` in its namespace.
#pragma once

#include <type_traits>
#include <utility>

namespace axial::refractive {

template <class T>
using Mask = std::decay_t<decltype(std::declval<const T&>() < std::declval<const T&>())>;

template <class T>
T select(bool condition, const T& yes, const T& no) {
  return condition ? yes : no;
}

// The second one if either is NaN.
template <class T>
T lesser(const T& a, const T& b) {
  return a < b ? a : b;
}
template <class T>
T greater(const T& a, const T& b) {
  return a > b ? a : b;
}

// True where projections take a fixed number of steps without branches: single precision, also in
// packs of lanes. All other scalars iterate to convergence.
template <class T>
inline constexpr bool kFixedSteps = std::is_same_v<T, float>;

}  // namespace axial::refractive
