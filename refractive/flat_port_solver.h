// SPDX-License-Identifier: BSD-3-Clause
// The equation of the exact forward projection through a flat port (axis frame, metres). Consider
// a point at the distance rho from the axis and at the height z_water above the outer plane. The
// in-air tangent t of the ray through this point is the root of
//
//     t (d_a + d_g/q_g(t^2) + z_water/q_w(t^2)) - rho = 0
//
// where d_a is the port's distance and d_g is its thickness. flat_port.h defines q_g and q_w. The
// equation is solved for m = t / rho, because m is finite on the axis and depends on rho only
// through rho^2:
//
//     F(m) = m (d_a + d_g/q_g(s) + z_water/q_w(s)) - 1 = 0              with s = m^2 rho^2
//
// F is increasing and concave for m >= 0.
#pragma once

#include <cmath>

#include "refractive/flat_port.h"
#include "refractive/scalar.h"

namespace axial::refractive {

// The points that a camera can see: points in water whose in-air tangent is at most the largest
// tangent of the image. At the height z_water above the outer plane, these points fill a disc
// around the axis. The radius of the disc is offset + slope * z_water, which is
// FlatPortOptics::radius() at the largest tangent. The disc contains exactly these points, because
// FlatPortOptics::radius() increases with the tangent. Points outside the field must not reach the
// fixed-step solver, because the solver could return a pixel inside the image for them.
template <class T>
struct FlatPortField {
  T offset, slope;  // of the disc's radius: offset [m]; slope [m/m]
  // At a fixed tangent t, the secant radius / t is a linear function of z_water. `known_...`: the
  // coefficients of this function at t = `promised` (see the constructor), where the first guess of
  // the solver is exact. `paraxial_...`: the coefficients for t -> 0, on the axis. inv_known2 is
  // 1 / promised^2.
  T known_offset, known_slope, inv_known2;
  T paraxial_offset, paraxial_slope;
  int steps;  // of the solver in single precision; all other scalars ignore it

  FlatPortField() = default;  // invalid until each_field() has filled it
  // `tangent`: the largest in-air tangent of the field. `promised`: the largest in-air tangent
  // with full accuracy in single precision. Precondition: 0 < promised <= tangent. The number of
  // steps in single precision is chosen for `promised`. In an image of 1024 px width, the errors
  // stay below 1e-4 px up to `promised`, and below 0.01 px up to 1.3 times `promised`.
  FlatPortField(const FlatPortOptics<T>& optics, const T& tangent, const T& promised)
      : inv_known2(T(1) / (promised * promised)),
        paraxial_offset(optics.paraxial_secant(T(0))),
        paraxial_slope(optics.water.inv_mu),
        steps(promised < T(1.15) ? 1 : (promised < T(4.5) ? 2 : (promised < T(7) ? 3 : 5))) {
    const auto secant = [&](const T& t, T& offset_, T& slope_) {
      const T s = t * t;
      offset_ = optics.distance + optics.thickness / optics.glass.q(s);
      slope_ = T(1) / optics.water.q(s);
    };
    secant(promised, known_offset, known_slope);
    secant(tangent, offset, slope);
    offset *= tangent, slope *= tangent;
  }

  // Calls visit(number) for every member above, in a fixed order. The SIMD code uses it as it uses
  // FlatPortCamera::each_field().
  template <class Visit>
  void each_field(Visit&& visit) {
    visit(offset), visit(slope);
    visit(known_offset), visit(known_slope), visit(inv_known2);
    visit(paraxial_offset), visit(paraxial_slope);
    visit(steps);
  }

  // The radius [m] of the disc at the height `z_water` [m].
  T radius(const T& z_water) const { return offset + slope * z_water; }

  // True if the field contains the point. rho2: squared distance of the point to the axis [m^2].
  // z_water: height of the point above the outer plane [m]. False for NaN. False if z_water is
  // 0.1 mm or less, or 100 km or more, in single precision; for all other scalars the limits are
  // 1 nm and a million kilometres.
  Mask<T> contains(const T& rho2, const T& z_water) const {
    const T edge = radius(z_water);
    return z_water > T(kLowest) && z_water < T(kHighest) && rho2 <= edge * edge;
  }

  // The height [m] and the squared radius [m^2] at which the solver evaluates a point. A point in
  // the field keeps its values. The values of all other points are limited to the edge of the
  // field. A NaN height becomes the lowest height, and a NaN rho2 becomes the edge. Precondition
  // of nearest_rho2(): z_water is a result of nearest_height().
  T nearest_height(const T& z_water) const {
    return lesser(greater(z_water, T(kLowest)), T(kHighest));
  }
  T nearest_rho2(const T& rho2, const T& z_water) const {
    const T edge = radius(z_water);
    return lesser(rho2, edge * edge);
  }

 private:
  // Limits of z_water [m]. The solver forms sixth powers of lengths, which must stay within the
  // range of single precision.
  static constexpr float kLowest = kFixedSteps<T> ? 1e-4f : 1e-9f;
  static constexpr float kHighest = kFixedSteps<T> ? 1e5f : 1e9f;
};

// m = t / rho as a fraction, the inverse of the secant rho / t. Terms in m^2 are computed from
// numerator and denominator, so that they do not wait for the division.
template <class T>
struct InverseSecant {
  T numerator, denominator;

  T value() const { return numerator / denominator; }
};

// F and its derivatives at m. The code minimises the length of the chain of dependent operations,
// not the number of operations. Terms without a square root are computed while the processor
// computes the square roots.
template <class T>
struct FlatPortSlopes {
  T inv_qw;             // 1/q_w
  T inv_qw_slope;       // derivative of inv_qw by m
  T secant;             // (F + 1) / m, which is radius / t
  T tangent;            // dF/dm, which is d(radius)/dt
  T half_curvature;     // half of the second derivative d^2F/dm^2
  T spread;             // (secant - tangent) / s
  T half_spread_slope;  // half of d(spread)/dm

  FlatPortSlopes(const FlatPortOptics<T>& optics, const InverseSecant<T>& fraction, const T& rho2,
                 const T& z_water) {
    using std::sqrt;
    const T& scale = fraction.denominator;
    const T scale2 = scale * scale;
    const T scaled_s = fraction.numerator * fraction.numerator * rho2;
    const T q2_g = optics.glass.b * scale2 + optics.glass.c * scaled_s;  // times scale2
    const T q2_w = optics.water.b * scale2 + optics.water.c * scaled_s;
    const T over_g = scale / q2_g, over_w = scale / q2_w;
    const T g2 = scale * over_g, w2 = scale * over_w;  // 1/q^2
    const T root_w = sqrt(q2_w);
    const T g = sqrt(q2_g) * (optics.thickness * over_g);
    const T w = root_w * (z_water * over_w);
    inv_qw = root_w * over_w;
    const T g_b = g2 * optics.glass.b, g_c = g2 * optics.glass.c;
    const T w_b = w2 * optics.water.b, w_c = w2 * optics.water.c;
    secant = optics.distance + g + w;
    tangent = optics.distance + g * g_b + w * w_b;
    const T spread_g = g * g_c, spread_w = w * w_c;
    spread = spread_g + spread_w;
    const T lever = fraction.value() * rho2;
    const T twist = T(-1.5) * lever;
    half_curvature = twist * (spread_g * g_b + spread_w * w_b);
    half_spread_slope = twist * (spread_g * g_c + spread_w * w_c);
    inv_qw_slope = -(lever * w_c) * inv_qw;
  }

  FlatPortSlopes(const FlatPortOptics<T>& optics, const T& m, const T& rho2, const T& z_water)
      : FlatPortSlopes(optics, {m, T(1)}, rho2, z_water) {}
};

// The first guess of m: 1 / secant, with an interpolated secant radius / t. The interpolation is
// linear in the squared radius. The interpolated secant is exact on the axis and at the known
// tangent, `promised` of FlatPortField. Compared with the paraxial guess, this guess saves more
// than one step. Far beyond the known tangent, the interpolated secant would become zero or
// negative, and no step could correct such a guess. Therefore a secant below half the secant at the
// known tangent is raised to this half.
template <class T>
struct FirstGuess {
  InverseSecant<T> m;
  Mask<T> beyond;  // the point lies beyond the known tangent

  FirstGuess(const FlatPortField<T>& field, const T& rho2, const T& z_water) {
    const T known = field.known_offset + field.known_slope * z_water;
    const T paraxial = field.paraxial_offset + field.paraxial_slope * z_water;
    const T known2 = known * known;
    const T known3 = known * known2;
    const T scale = paraxial * known2 + (known - paraxial) * field.inv_known2 * rho2;
    beyond = scale < known3;
    m = {known2, greater(scale, T(0.5) * known3)};
  }
};

// The number that a step of Halley's method subtracts from m. `at`: F and its derivatives at m.
template <class T>
T halley_step(const FlatPortSlopes<T>& at, const T& m) {
  const T f = m * at.secant - T(1);
  return f * at.tangent / (at.tangent * at.tangent - f * at.half_curvature);
}

// The root, and the terms that the derivative of the projection needs at the root.
template <class T>
struct FlatPortRoot {
  T m;       // t / rho, in-air tangent over radius
  T slope;   // dt/d(rho)
  T spread;  // (1/m - 1/slope) / t^2
  T inv_qw;  // 1/q_w
};

namespace detail {

// Solves F(m) = 0 in field.steps steps. The last step is a step of Chebyshev's method, which has
// third order, like Halley's method. Chebyshev's step needs only the division by dF/dm, which the
// derivative of the projection needs as well. The terms for the derivative are extrapolated to
// first order from the start of the last step to the root. This is sufficient, because only the
// Jacobian uses them.
template <class T>
FlatPortRoot<T> solve_in_fixed_steps(const FlatPortOptics<T>& optics, const FlatPortField<T>& field,
                                     const T& rho2, const T& z_water) {
  const FirstGuess<T> guess(field, rho2, z_water);
  FlatPortSlopes<T> at(optics, guess.m, rho2, z_water);
  T m = guess.m.value();
  // Far outside the image the steps may be inaccurate. The lower bound prevents that they lead back
  // into the image.
  const T lowest = select(guess.beyond, T(0.5) * m, T(0));
  for (int step = 1; step < field.steps; ++step) {
    m -= halley_step(at, m);
    at = FlatPortSlopes<T>(optics, m, rho2, z_water);
  }
  const T slope = T(1) / at.tangent;
  const T f = m * at.secant - T(1);
  const T bend = f * at.half_curvature;
  const T slope2 = slope * slope;
  const T newton = f * slope;
  const T beyond = (f * bend * slope) * slope2;
  const T down = newton + beyond;
  return {greater((m - newton) - beyond, lowest), slope + slope * (slope2 * (bend + bend)),
          at.spread - at.half_spread_slope * (down + down), at.inv_qw - at.inv_qw_slope * down};
}

template <class T>
FlatPortRoot<T> solve_to_convergence(const FlatPortOptics<T>& optics, const FlatPortField<T>& field,
                                     const T& rho2, const T& z_water) {
  T m = FirstGuess<T>(field, rho2, z_water).m.value();
  for (int step = 0; step < 2; ++step)
    m -= halley_step(FlatPortSlopes<T>(optics, m, rho2, z_water), m);
  // F is increasing and concave, so a Newton step ends at or below the root. From a point below the
  // root, Newton's method rises monotonically. The paraxial solution lies below the root and is a
  // lower bound of all steps. If a step does not rise, only rounding errors are left.
  const T lowest = T(1) / optics.paraxial_secant(z_water);
  for (int step = 0; step < 60; ++step) {
    const FlatPortSlopes<T> at(optics, m, rho2, z_water);
    T next = m - (m * at.secant - T(1)) / at.tangent;
    if (next < lowest) next = lowest;
    const bool rising = next > m;
    m = next;
    if (!rising && step > 0) break;
  }
  // One more step from the root gives automatic-differentiation scalars their derivatives.
  const FlatPortSlopes<T> near(optics, m, rho2, z_water);
  m = m - (m * near.secant - T(1)) / near.tangent;
  const FlatPortSlopes<T> at(optics, m, rho2, z_water);
  return {m, T(1) / at.tangent, at.spread, at.inv_qw};
}

}  // namespace detail

// Solves F(m) = 0. `rho2`: squared distance of the point to the axis [m^2]. `z_water`: height of
// the point above the outer plane [m]. Precondition: `field` contains the point, or the point lies
// on the edge of `field`.
template <class T>
FlatPortRoot<T> solve_projection(const FlatPortOptics<T>& optics, const FlatPortField<T>& field,
                                 const T& rho2, const T& z_water) {
  if constexpr (kFixedSteps<T>)
    return detail::solve_in_fixed_steps(optics, field, rho2, z_water);
  else
    return detail::solve_to_convergence(optics, field, rho2, z_water);
}

}  // namespace axial::refractive
