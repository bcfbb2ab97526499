// SPDX-License-Identifier: BSD-3-Clause
// The distortion of a lens. One formula covers all of COLMAP's polynomial models, including the
// fisheyes, and its FOV model. COLMAP's documentation describes the camera models.
//
// A direction in air (u, v, 1) is first mapped to the plane in which the polynomials are defined,
//
//     e = spread (u, v)                      perspective lenses (spread is 1)
//     e = spread (u, v) theta / tan(theta)   fisheyes, with tan(theta) = spread |(u, v)|
//
// and then distorted, with s = |e|^2 and e = (x, y):
//
//     d = e (above_0 + above_1 s + ... + above_4 s^4) / (1 + below_1 s + ... + below_3 s^3)
//         + (2 p1 x y + p2 (s + 2 x^2), 2 p2 x y + p1 (s + 2 y^2)) + prism s
//
// A pixel is (fx d_x + cx, fy d_y + cy).
#pragma once

#include <array>

#include "refractive/axial_ray.h"
#include "refractive/equidistant.h"

namespace axial::refractive {

// The result of a mapping f from plane to plane at a point p: `point` is f(p), and `by` is df/dp.
template <class T>
struct PlanePoint {
  Vector2<T> point;
  Matrix2<T> by;
};

// The parameters of the formulas above. Their defaults describe a lens without distortion.
template <class T>
struct LensDistortion {
  T fisheye = T(0);  // 1: fisheye, 0: perspective; a T, so that each SIMD lane has its own value
  T spread = T(1);
  std::array<T, 5> above{T(1), T(0), T(0), T(0), T(0)};  // above_0 to above_4; above_0 is not 0
  std::array<T, 3> below{T(0), T(0), T(0)};              // below_1 to below_3
  T p1 = T(0), p2 = T(0);
  Vector2<T> prism{T(0), T(0)};

  bool operator==(const LensDistortion&) const = default;

  template <class U>
  LensDistortion<U> cast() const;

  // Calls visit(number) for every number of the distortion, in a fixed order. The SIMD code uses it
  // as it uses FlatPortCamera::each_field().
  template <class Visit>
  void each_field(Visit&& visit) {
    visit(fisheye), visit(spread);
    for (T& a : above) visit(a);
    for (T& b : below) visit(b);
    visit(p1), visit(p2), visit(prism.x()), visit(prism.y());
  }

  // spread_out() maps the tangents (u, v) to e. drawn_in() is the inverse and maps e to the
  // tangents. Precondition of drawn_in() for a fisheye: |e| < pi/2.
  PlanePoint<T> spread_out(const Vector2<T>& tangents) const;
  PlanePoint<T> drawn_in(const Vector2<T>& e) const;

  // Maps e to d. `by` is d(d)/d(e).
  PlanePoint<T> bent(const Vector2<T>& e) const;

  // The inverse of bent() by Newton's method: maps d to e. `by` is d(e)/d(d). The result is limited
  // to |e| <= radius. If no e with |e| <= radius is mapped to d, the result is a point of the
  // circle |e| = radius, roughly in the direction of d. A NaN argument gives NaN.
  PlanePoint<T> straightened(const Vector2<T>& d, const T& radius) const;
};

// The determinant and the inverse of m, for every scalar type. The inverse of a singular m has
// elements that are infinite or NaN.
template <class T>
T determinant_of(const Matrix2<T>& m) {
  return m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0);
}

template <class T>
Matrix2<T> inverse_of(const Matrix2<T>& m) {
  const T inv = T(1) / determinant_of(m);
  Matrix2<T> inverse;
  inverse << m(1, 1) * inv, -m(0, 1) * inv, -m(1, 0) * inv, m(0, 0) * inv;
  return inverse;
}

namespace detail {

// The matrix across I + (along - across) p p^T / |p|^2, which scales by `along` in the direction
// of p and by `across` perpendicular to p. p2: |p|^2.
template <class T>
Matrix2<T> stretch(const Vector2<T>& p, const T& p2, const T& along, const T& across) {
  // The lower bound avoids a division by zero at the centre, where `along` - `across` is a rounding
  // error.
  const T turn = (along - across) / greater(p2, T(1e-12));
  Matrix2<T> matrix;
  matrix << across + turn * p.x() * p.x(), turn * p.x() * p.y(),  //
      turn * p.x() * p.y(), across + turn * p.y() * p.y();
  return matrix;
}

// Returns p if |p| <= radius. Otherwise returns p shortened to the length `radius`.
template <class T>
Vector2<T> within(const Vector2<T>& p, const T& radius) {
  using std::sqrt;
  const T p2 = p.x() * p.x() + p.y() * p.y();
  const Mask<T> outside = p2 > radius * radius;
  const T share = select(outside, radius / sqrt(select(outside, p2, T(1))), T(1));
  return {share * p.x(), share * p.y()};
}

}  // namespace detail

template <class T>
template <class U>
LensDistortion<U> LensDistortion<T>::cast() const {
  LensDistortion<U> to;
  to.fisheye = static_cast<U>(fisheye);
  to.spread = static_cast<U>(spread);
  for (std::size_t k = 0; k < above.size(); ++k) to.above[k] = static_cast<U>(above[k]);
  for (std::size_t k = 0; k < below.size(); ++k) to.below[k] = static_cast<U>(below[k]);
  to.p1 = static_cast<U>(p1);
  to.p2 = static_cast<U>(p2);
  to.prism = prism.template cast<U>();
  return to;
}

template <class T>
PlanePoint<T> LensDistortion<T>::spread_out(const Vector2<T>& tangents) const {
  const Vector2<T> q = spread * tangents;
  const T r2 = q.x() * q.x() + q.y() * q.y();
  const Mask<T> bends = fisheye > T(0);
  const T across = select(bends, arc_over_tangent(r2), T(1));
  const T along = select(bends, T(1) / (T(1) + r2), T(1));
  return {across * q, spread * detail::stretch(q, r2, along, across)};
}

template <class T>
PlanePoint<T> LensDistortion<T>::drawn_in(const Vector2<T>& e) const {
  const T theta2 = e.x() * e.x() + e.y() * e.y();
  const Mask<T> bends = fisheye > T(0);
  // e of a perspective lens is not an angle, and may be too large for tangent_over_arc().
  const T across = select(bends, tangent_over_arc(select(bends, theta2, T(0))), T(1));
  const T along = select(bends, T(1) + across * across * theta2, T(1));
  const T inv = T(1) / spread;
  return {(across * inv) * e, inv * detail::stretch(e, theta2, along, across)};
}

template <class T>
PlanePoint<T> LensDistortion<T>::bent(const Vector2<T>& e) const {
  const T x = e.x(), y = e.y();
  const T s = x * x + y * y;
  const T inv_below = T(1) / (T(1) + s * detail::power_series(below, s));
  const T ratio = detail::power_series(above, s) * inv_below;
  // The coefficients of the derivatives by s; `slope` is 2 d(ratio)/ds.
  const std::array<T, 4> above_slope{above[1], T(2) * above[2], T(3) * above[3], T(4) * above[4]};
  const std::array<T, 3> below_slope{below[0], T(2) * below[1], T(3) * below[2]};
  const T slope =
      T(2) * inv_below *
      (detail::power_series(above_slope, s) - ratio * detail::power_series(below_slope, s));

  PlanePoint<T> d;
  d.point = {x * ratio + T(2) * p1 * x * y + p2 * (s + T(2) * x * x) + prism.x() * s,
             y * ratio + T(2) * p2 * x * y + p1 * (s + T(2) * y * y) + prism.y() * s};
  const T shear = slope * x * y + T(2) * (p1 * x + p2 * y);
  d.by << ratio + slope * x * x + T(2) * (p1 * y + (T(3) * p2 + prism.x()) * x),
      shear + T(2) * prism.x() * y,  //
      shear + T(2) * prism.y() * x,
      ratio + slope * y * y + T(2) * (p2 * x + (T(3) * p1 + prism.y()) * y);
  return d;
}

template <class T>
PlanePoint<T> LensDistortion<T>::straightened(const Vector2<T>& d, const T& radius) const {
  Vector2<T> e = detail::within<T>(d * (T(1) / above[0]), radius);
  const auto step = [&] {
    const PlanePoint<T> at = bent(e);
    const Matrix2<T> inverse = inverse_of(at.by);
    const Vector2<T> next = e - Vector2<T>(inverse * (at.point - d));
    e = detail::within(next, radius);
    return inverse;
  };
  if constexpr (kFixedSteps<T>) {
    constexpr int kSteps = 8;  // two more than any lens of the tests needs
    for (int k = 0; k < kSteps; ++k) step();
  } else {
    constexpr int kMostSteps = 60;
    const T rounding = T(1e-31) * radius * radius;
    for (int k = 0; k < kMostSteps; ++k) {
      // NOLINTNEXTLINE(performance-unnecessary-copy-initialization): step() changes e.
      const Vector2<T> before = e;
      step();
      if (!((e - before).squaredNorm() > rounding)) break;
    }
  }
  // One more step from the root gives automatic-differentiation scalars their derivatives.
  const Matrix2<T> by = step();
  return {e, by};
}

}  // namespace axial::refractive
