// SPDX-License-Identifier: GPL-3.0-or-later
// The one equation of the exact forward projection: which in-air tangent t reaches the radius rho
// at height z_water above the outer plane of a flat port,
//
//     F(t) = t (d_a + d_g/q_g(t^2) + z_water/q_w(t^2)) - rho = 0        (axis frame, metres)
//
// F is increasing and concave for t >= 0.
#pragma once

#include <cmath>

#include "refractive/flat_port.h"

namespace axial::refractive {

// The points a camera can see: in water, and within the in-air incidence t <= largest_tangent on
// the port. At height z_water above the outer plane that is a disc of radius offset + slope *
// z_water; exact, because radius(t, z_water) increases with t. Points outside need no projection,
// and must not reach the fixed-step solver, which could land inside the image.
template <class T>
struct FlatPortField {
  T offset, slope, inv_largest_tangent;
  int halley_steps;  // for single precision: errors below 1e-4 px of a 1024 px wide image

  FlatPortField() = default;
  FlatPortField(const FlatPortOptics<T>& optics, const T& tangent)
      : inv_largest_tangent(T(1) / tangent),
        halley_steps(tangent < T(1.35) ? 1 : (tangent < T(7) ? 2 : 4)) {
    const T s = tangent * tangent;
    offset = tangent * (optics.distance + optics.thickness / optics.glass.q(s));
    slope = tangent / optics.water.q(s);
  }

  T radius(const T& z_water) const { return offset + slope * z_water; }

  // False for NaN. The bounds on the height (a nanometre, a million kilometres) keep the squares
  // and cubes of single precision within its range.
  Mask<T> contains(const T& rho, const T& z_water) const {
    return z_water > T(1e-9) && z_water < T(1e9) && rho <= radius(z_water);
  }
};

// F + rho = t * secant, and its derivatives.
template <class T>
struct FlatPortSlopes {
  T inv_qw;
  T secant;     // radius / t
  T tangent;    // d(radius)/dt
  T curvature;  // d2(radius)/dt2

  FlatPortSlopes(const FlatPortOptics<T>& optics, const T& t, const T& z_water) {
    const T s = t * t;
    const T q_g = optics.glass.q(s);
    const T q_w = optics.water.q(s);
    const T inv = T(1) / (q_g * q_w);  // one division for both
    const T inv_qg = inv * q_w;
    inv_qw = inv * q_g;
    const T g = optics.thickness * inv_qg;
    const T w = z_water * inv_qw;
    const T g2 = inv_qg * inv_qg;
    const T w2 = inv_qw * inv_qw;
    const T g3 = g * g2 * optics.glass.b;
    const T w3 = w * w2 * optics.water.b;
    secant = optics.distance + g + w;
    tangent = optics.distance + g3 + w3;
    curvature = T(-3) * t * (g3 * g2 * optics.glass.c + w3 * w2 * optics.water.c);
  }
};

// The inverse of a guessed secant between the paraxial one, exact on the axis, and that of the
// field's edge, where the root is known: the secant runs from one to the other like the square of
// the radius. Two Halley steps from here are better than three from the paraxial guess (1e-5 px
// against 4e-4 px for 110 degrees and 15 degrees of tilt), and one step is as good as three up to
// 80 degrees without tilt (8e-5 px).
template <class T>
T initial_inverse_secant(const FlatPortOptics<T>& optics, const FlatPortField<T>& field,
                         const T& rho, const T& z_water) {
  const T edge_radius = field.radius(z_water);
  const T paraxial = optics.paraxial_secant(z_water);
  const T edge = edge_radius * field.inv_largest_tangent;
  const T edge2 = edge_radius * edge_radius;
  return edge2 / (paraxial * edge2 + (edge - paraxial) * (rho * rho));
}

// How far Halley's step goes down from t, where the slopes are `at`.
template <class T>
T halley_step(const FlatPortSlopes<T>& at, const T& t, const T& rho) {
  const T f = t * at.secant - rho;
  return f * at.tangent / (at.tangent * at.tangent - T(0.5) * f * at.curvature);
}

// The root and what the projection needs there.
template <class T>
struct FlatPortRoot {
  T t;
  T inv_secant;  // t / rho, also where both are 0
  T tangent;     // d(radius)/dt
  T inv_qw;
};

namespace detail {

// The slopes at the root are carried there from the last step's start, to second order: they only
// matter to the Jacobian.
template <class T>
FlatPortRoot<T> solve_in_fixed_steps(const FlatPortOptics<T>& optics, const FlatPortField<T>& field,
                                     const T& rho, const T& inv_rho, const T& z_water) {
  T inv_secant = initial_inverse_secant(optics, field, rho, z_water);
  T t = rho * inv_secant;
  for (int step = 1; step < field.halley_steps; ++step) {
    const T down = halley_step(FlatPortSlopes<T>(optics, t, z_water), t, rho);
    t -= down;
    inv_secant -= down * inv_rho;
  }
  const FlatPortSlopes<T> at(optics, t, z_water);
  const T down = halley_step(at, t, rho);
  const T water = optics.water.c * t * at.inv_qw * at.inv_qw * at.inv_qw;  // -d(1/q_w)/dt
  return {t - down, inv_secant - down * inv_rho, at.tangent - at.curvature * down,
          at.inv_qw + water * down};
}

template <class T>
FlatPortRoot<T> solve_to_convergence(const FlatPortOptics<T>& optics, const FlatPortField<T>& field,
                                     const T& rho, const T& z_water) {
  T t = rho * initial_inverse_secant(optics, field, rho, z_water);
  for (int step = 0; step < 2; ++step)
    t -= halley_step(FlatPortSlopes<T>(optics, t, z_water), t, rho);
  // A Newton step of a concave function ends left of the root, the paraxial guess lies left of it
  // too, and from there Newton rises monotonically: a step that no longer rises is rounding.
  const T lowest = rho / optics.paraxial_secant(z_water);
  for (int step = 0; step < 60; ++step) {
    const FlatPortSlopes<T> at(optics, t, z_water);
    T next = t - (t * at.secant - rho) / at.tangent;
    if (next < lowest) next = lowest;
    const bool rising = next > t;
    t = next;
    if (!rising && step > 0) break;
  }
  // One step from the root itself carries the derivatives of automatic-differentiation scalars.
  const FlatPortSlopes<T> near(optics, t, z_water);
  t = t - (t * near.secant - rho) / near.tangent;
  const FlatPortSlopes<T> at(optics, t, z_water);
  return {t, T(1) / at.secant, at.tangent, at.inv_qw};
}

}  // namespace detail

// The root, for rho and z_water that the field contains. `inv_rho`: 1/rho, 0 on the axis.
template <class T>
FlatPortRoot<T> solve_tangent(const FlatPortOptics<T>& optics, const FlatPortField<T>& field,
                              const T& rho, const T& inv_rho, const T& z_water) {
  if constexpr (kFixedSteps<T>)
    return detail::solve_in_fixed_steps(optics, field, rho, inv_rho, z_water);
  else
    return detail::solve_to_convergence(optics, field, rho, z_water);
}

}  // namespace axial::refractive
