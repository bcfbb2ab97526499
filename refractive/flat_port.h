// SPDX-License-Identifier: BSD-3-Clause
// A flat port: a plate of glass with parallel faces between the lens and the water.
// docs/refraction.md derives the formulas.
//
// Axis frame: origin at the camera centre, z along the port's normal, metres. In this frame a
// direction in air is (x, y, 1). Let s = x^2 + y^2, the squared tangent of the angle between the
// direction and the normal. Let mu_g and mu_w be the refractive indices of glass and water
// relative to air. With
//
//     q_g = sqrt(mu_g^2 + (mu_g^2 - 1) s)        q_w = sqrt(mu_w^2 + (mu_w^2 - 1) s)
//
// Snell's law reads tan(theta_glass) = sqrt(s)/q_g and tan(theta_water) = sqrt(s)/q_w. Here theta
// is the angle between the ray and the normal in the named medium.
#pragma once

#include <cmath>

#include "refractive/axial_ray.h"

namespace axial::refractive {

// The measured parameters of the port, in the camera frame. Preconditions: unit normal with
// normal.z > 0; distance and thickness >= 0; n_glass and n_water >= n_air > 0. This type does not
// check its preconditions. They are checked when a housing is read.
template <class T>
struct FlatPort {
  Vector3<T> normal{T(0), T(0), T(1)};  // from the camera to the water
  T distance = T(0);                    // camera centre to the inner (air/glass) plane [m]
  T thickness = T(0);                   // of the glass [m]
  T n_air = T(1);
  T n_glass = T(1);
  T n_water = T(1);

  bool operator==(const FlatPort&) const = default;

  template <class U>
  FlatPort<U> cast() const {
    return {normal.template cast<U>(), static_cast<U>(distance), static_cast<U>(thickness),
            static_cast<U>(n_air),     static_cast<U>(n_glass),  static_cast<U>(n_water)};
  }
};

// A medium with the refractive index mu relative to air. Its q(s), defined above as q_g and q_w, is
// sqrt(b + c s) with b = mu^2 and c = mu^2 - 1. inv_mu is 1/mu.
template <class T>
struct Medium {
  T b, c, inv_mu;

  Medium() = default;  // the members have no values
  explicit Medium(const T& mu) : b(mu * mu), c(mu * mu - T(1)), inv_mu(T(1) / mu) {}

  // q(s)^2 and q(s). `s`: squared tangent of the angle between the direction in air and the normal.
  T q2(const T& s) const { return b + c * s; }
  T q(const T& s) const {
    using std::sqrt;
    return sqrt(q2(s));
  }
};

// The port's geometry and media in the axis frame. The normal is not needed in this frame.
template <class T>
struct FlatPortOptics {
  T distance, thickness;  // of FlatPort [m]
  Medium<T> glass, water;

  FlatPortOptics() = default;  // invalid until each_field() has filled it
  explicit FlatPortOptics(const FlatPort<T>& port)
      : distance(port.distance),
        thickness(port.thickness),
        glass(port.n_glass / port.n_air),
        water(port.n_water / port.n_air) {}

  // Calls visit(number) for every number of the members, in a fixed order. The SIMD code uses it as
  // it uses FlatPortCamera::each_field().
  template <class Visit>
  void each_field(Visit&& visit) {
    visit(distance), visit(thickness);
    for (Medium<T>* medium : {&glass, &water})
      visit(medium->b), visit(medium->c), visit(medium->inv_mu);
  }

  // The z [m] of the outer (glass/water) plane.
  T outer() const { return distance + thickness; }

  // The limit [m] of radius(t, z_water) / t for t -> 0: radius() over t for a ray near the axis.
  T paraxial_secant(const T& z_water) const {
    return distance + thickness * glass.inv_mu + z_water * water.inv_mu;
  }

  // The distance [m] from the axis at which a ray reaches the height `z_water` [m] above the outer
  // plane. `t`: tangent of the angle between the ray in air and the axis. The result is strictly
  // increasing in t.
  T radius(const T& t, const T& z_water) const {
    const T s = t * t;
    return t * (distance + thickness / glass.q(s) + z_water / water.q(s));
  }

  // The z [m] of the virtual centre C_v: the point at which the line of the ray in water meets the
  // axis. `s`: squared tangent of the angle between the ray in air and the axis.
  T virtual_centre(const T& s) const {
    const T q_w = water.q(s);
    return outer() - (distance + thickness / glass.q(s)) * q_w;
  }
};

}  // namespace axial::refractive
