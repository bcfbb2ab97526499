// SPDX-License-Identifier: BSD-3-Clause
// A dome port: a spherical shell of glass, with centre C, between the lens and the water. The
// camera centre may lie anywhere within the inner sphere. docs/refraction.md explains the formulas.
//
// A ray that is refracted at spheres around C stays in its plane through C. The product of the
// refractive index and the ray's distance from C is constant (Bouguer's law). Let r be the unit
// direction in air, k = |r x C| the distance of the ray in air from C, and mu_g and mu_w the
// indices of glass and water relative to air. At a sphere of radius R, let mu be the index on one
// side of the sphere. The sine of the angle between ray and normal on this side is k i with
// i = 1/(mu R). At each sphere the ray turns by the difference of the two angles. With the radii
// r_in and r_out of the inner and the outer sphere, the ray turns away from the axis through the
// camera centre and C by the angle
//
//     delta = asin(k i_1) - asin(k i_2) + asin(k i_3) - asin(k i_4)
//
//     i_1 = 1/r_in   i_2 = 1/(mu_g r_in)   i_3 = 1/(mu_g r_out)   i_4 = 1/(mu_w r_out).
//
// Let S = sin(delta)/k and Q = cos(delta) + (r.C) S. The unit direction of the ray in water is
// D = Q r - S C. The origin of the ray on the axis is C_v = (1 - 1/(mu_w Q)) C. S and cos(delta)
// are smooth functions of k^2, and their computation needs only square roots. So the formulas have
// no singularity at k = 0: on the axis, and for a dome whose centre is the camera centre.
#pragma once

#include <cmath>

#include "refractive/axial_ray.h"

namespace axial::refractive {

// The measured parameters of the port, in the camera frame. Preconditions: |centre| < inner_radius;
// thickness >= 0; n_glass and n_water >= n_air > 0. This type does not check its preconditions.
// They are checked when a housing is read.
template <class T>
struct DomePort {
  Vector3<T> centre{T(0), T(0), T(0)};  // of the spheres [m]
  T inner_radius = T(1);                // of the inner (air/glass) sphere [m]
  T thickness = T(0);                   // of the glass [m]
  T n_air = T(1);
  T n_glass = T(1);
  T n_water = T(1);

  bool operator==(const DomePort&) const = default;

  template <class U>
  DomePort<U> cast() const {
    return {centre.template cast<U>(), static_cast<U>(inner_radius), static_cast<U>(thickness),
            static_cast<U>(n_air),     static_cast<U>(n_glass),      static_cast<U>(n_water)};
  }
};

// Functions of the angle delta by which a ray turns. k is the distance [m] of the ray in air from
// C. All members are functions of k^2.
template <class T>
struct DomeTurn {
  T sine;                      // S = sin(delta) / k [1/m]
  T cosine;                    // cos(delta)
  T sine_slope, cosine_slope;  // derivatives of `sine` and `cosine` by k^2
};

// The port's geometry and media, in the symbols of the formulas above.
template <class T>
struct DomePortOptics {
  Vector3<T> centre;       // C [camera frame, m]
  T centre2;               // |C|^2 [m^2]
  T outer_radius;          // r_out [m]
  T in_air, in_glass;      // i_1, i_2 [1/m]
  T out_glass, out_water;  // i_3, i_4 [1/m]
  T inv_mu;                // 1/mu_w

  DomePortOptics() = default;  // invalid until each_field() has filled it
  explicit DomePortOptics(const DomePort<T>& port)
      : centre(port.centre),
        centre2(port.centre.squaredNorm()),
        outer_radius(port.inner_radius + port.thickness),
        in_air(T(1) / port.inner_radius),
        in_glass(port.n_air / (port.n_glass * port.inner_radius)),
        out_glass(port.n_air / (port.n_glass * outer_radius)),
        out_water(port.n_air / (port.n_water * outer_radius)),
        inv_mu(port.n_air / port.n_water) {}

  // Calls visit(number) for every member above, in a fixed order. The SIMD code uses it as it uses
  // FlatPortCamera::each_field().
  template <class Visit>
  void each_field(Visit&& visit) {
    visit(centre.x()), visit(centre.y()), visit(centre.z());
    visit(centre2), visit(outer_radius);
    visit(in_air), visit(in_glass), visit(out_glass), visit(out_water);
    visit(inv_mu);
  }

  // The value of S [1/m] on the axis, where k is 0.
  T axial_sine() const { return in_air - in_glass + out_glass - out_water; }

  // The functions of delta for one ray. `k2`: squared distance of the ray in air from C [m^2].
  // Precondition: k2 < inner_radius^2. Every ray through the camera centre fulfils it.
  DomeTurn<T> turn(const T& k2) const {
    const DomeTurn<T> inner = difference(in_air, in_glass, k2);
    const DomeTurn<T> outer = difference(out_glass, out_water, k2);
    DomeTurn<T> both;
    both.sine = inner.sine * outer.cosine + inner.cosine * outer.sine;
    both.cosine = inner.cosine * outer.cosine - k2 * inner.sine * outer.sine;
    both.sine_slope = inner.sine_slope * outer.cosine + inner.sine * outer.cosine_slope +
                      inner.cosine_slope * outer.sine + inner.cosine * outer.sine_slope;
    both.cosine_slope = inner.cosine_slope * outer.cosine + inner.cosine * outer.cosine_slope -
                        inner.sine * outer.sine -
                        k2 * (inner.sine_slope * outer.sine + inner.sine * outer.sine_slope);
    return both;
  }

 private:
  // The terms of DomeTurn for the angle asin(k a) - asin(k b) instead of delta.
  static DomeTurn<T> difference(const T& a, const T& b, const T& k2) {
    using std::sqrt;
    const T cos_a = sqrt(T(1) - k2 * a * a);
    const T cos_b = sqrt(T(1) - k2 * b * b);
    const T half_inv = T(-0.5) / (cos_a * cos_b);
    const T slope_a = a * a * cos_b * half_inv;
    const T slope_b = b * b * cos_a * half_inv;
    return {a * cos_b - b * cos_a, cos_a * cos_b + k2 * a * b, a * slope_b - b * slope_a,
            slope_a * cos_b + cos_a * slope_b + a * b};
  }
};

}  // namespace axial::refractive
