// SPDX-License-Identifier: BSD-3-Clause
// The equidistant fisheye. A direction in air at the angle theta from the optical axis has the
// tangents (x/z, y/z) of length r = tan(theta), and is imaged at the distance theta from the centre
// of the image plane. The ratios theta/tan(theta) and tan(theta)/theta are computed from r^2 and
// theta^2, so that they have no singularity in the centre.
#pragma once

#include <array>
#include <cmath>

#include "refractive/scalar.h"

namespace axial::refractive {

namespace detail {

// a[0] + a[1] x + a[2] x^2 + ...
template <class T, class A, std::size_t N>
T power_series(const std::array<A, N>& a, const T& x) {
  T sum(a[N - 1]);
  for (std::size_t i = N - 1; i-- > 0;) sum = sum * x + T(a[i]);
  return sum;
}

// theta / tan(theta) for tan^2(theta) = r2. The angle is halved twice by atan(r) = 2
// atan(r / (1 + sqrt(1 + r^2))). The tangent of the quarter angle is below 0.42, where nine terms
// of the series of the arc tangent have an error of 1e-8.
template <class T>
T arc_over_tangent_in_fixed_steps(const T& r2) {
  using std::sqrt;
  constexpr std::array<float, 9> kSeries{1.0f,       -1.0f / 3, 1.0f / 5,   -1.0f / 7, 1.0f / 9,
                                         -1.0f / 11, 1.0f / 13, -1.0f / 15, 1.0f / 17};
  const T half = T(1) / (T(1) + sqrt(T(1) + r2));
  const T half2 = r2 * half * half;
  const T quarter = T(1) / (T(1) + sqrt(T(1) + half2));
  return T(4) * half * quarter * power_series(kSeries, half2 * quarter * quarter);
}

// tan(theta) / theta as the quotient of two series: sin(theta) / theta and cos(theta). The errors
// of the series are below 1e-9 up to 90 degrees.
template <class T>
T tangent_over_arc_in_fixed_steps(const T& theta2) {
  constexpr std::array<float, 7> kSine{
      1.0f,          -1.0f / 6,        1.0f / 120,       -1.0f / 5040,
      1.0f / 362880, -1.0f / 39916800, 1.0f / 6227020800};
  constexpr std::array<float, 8> kCosine{
      1.0f,         -1.0f / 2,       1.0f / 24,        -1.0f / 720,
      1.0f / 40320, -1.0f / 3628800, 1.0f / 479001600, -1.0f / 8.71782912e10f};
  return power_series(kSine, theta2) / power_series(kCosine, theta2);
}

}  // namespace detail

// theta / tan(theta) as a function of r2 = tan^2(theta), for theta from 0 to below 90 degrees. The
// result is 1 for r2 = 0.
template <class T>
T arc_over_tangent(const T& r2) {
  if constexpr (kFixedSteps<T>) {
    return detail::arc_over_tangent_in_fixed_steps(r2);
  } else {
    using std::atan;
    using std::sqrt;
    if (r2 < T(1e-4))
      return detail::power_series(std::array{1.0, -1.0 / 3, 1.0 / 5, -1.0 / 7, 1.0 / 9}, r2);
    const T r = sqrt(r2);
    return atan(r) / r;
  }
}

// tan(theta) / theta as a function of theta^2 [rad^2]. The result is 1 for theta = 0. Precondition:
// theta below 90 degrees.
template <class T>
T tangent_over_arc(const T& theta2) {
  if constexpr (kFixedSteps<T>) {
    return detail::tangent_over_arc_in_fixed_steps(theta2);
  } else {
    using std::sqrt;
    using std::tan;
    if (theta2 < T(1e-4))
      return detail::power_series(std::array{1.0, 1.0 / 3, 2.0 / 15, 17.0 / 315, 62.0 / 2835},
                                  theta2);
    const T theta = sqrt(theta2);
    return tan(theta) / theta;
  }
}

}  // namespace axial::refractive
