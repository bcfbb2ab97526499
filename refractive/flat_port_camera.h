// SPDX-License-Identifier: GPL-3.0-or-later
// A pinhole lens behind a flat port: the exact axial camera, in closed form both ways.
//
// Everything is computed in the camera frame: with n the port's normal, a vector's part across the
// axis, v - (n.v) n, plays the role of the x and y of the axis frame, so that a tilt costs nothing.
#pragma once

#include <cmath>

#include "refractive/flat_port.h"
#include "refractive/flat_port_solver.h"
#include "refractive/pinhole_camera.h"

namespace axial::refractive {

// Rotation from the camera frame to the axis frame of a port with the given unit normal: the
// smallest rotation that takes the normal to +z. Precondition normal.z > -1.
template <class T>
Matrix3<T> axis_from_camera(const Vector3<T>& n) {
  const T k = T(1) / (T(1) + n.z());
  Matrix3<T> rotation;
  rotation << T(1) - k * n.x() * n.x(), -k * n.x() * n.y(), -n.x(),  //
      -k * n.x() * n.y(), T(1) - k * n.y() * n.y(), -n.y(),          //
      n.x(), n.y(), n.z();
  return rotation;
}

// Tangent of the largest in-air incidence on the port over the image rectangle, widened by `margin`
// pixels on every side; the corners decide, because the pixels within an incidence form a convex
// set. Corners that look away from the port (tilt and field of view beyond 90 degrees) count as
// `kGrazing`.
template <class T>
T largest_incidence_tangent(const PinholeLens<T>& lens, const FlatPort<T>& port, int width,
                            int height, const T& margin) {
  using std::sqrt;
  const T kGrazing(50);  // 88.9 degrees
  T largest = T(1e-3);
  for (const T& u : {-margin, T(width - 1) + margin}) {
    for (const T& v : {-margin, T(height - 1) + margin}) {
      const Vector3<T> bearing = lens.bearing({u, v});
      const T along = bearing.dot(port.normal);
      if (!(along > T(0))) return kGrazing;
      const Vector3<T> across = bearing - along * port.normal;
      const T tangent2 = across.squaredNorm() / (along * along);
      if (tangent2 > largest * largest) largest = sqrt(tangent2);
    }
  }
  return largest < kGrazing ? largest : kGrazing;
}

// `T` is float, double or an automatic-differentiation scalar. Float runs a fixed number of Halley
// steps without branches; every other scalar iterates to convergence.
template <class T>
class FlatPortCamera {
 public:
  using Scalar = T;

  // width, height: the image in pixels. Points are projected within the image widened by `margin`
  // pixels on every side (default: an eighth of the longer side).
  FlatPortCamera(const PinholeLens<T>& lens, const FlatPort<T>& port, int width, int height,
                 int margin = -1)
      : lens_(lens),
        inv_fx_(T(1) / lens.fx),
        inv_fy_(T(1) / lens.fy),
        port_(port),
        optics_(port),
        lowest_(-T(margin_or_default(width, height, margin))),
        highest_u_(T(width - 1) - lowest_),
        highest_v_(T(height - 1) - lowest_),
        field_(optics_, largest_incidence_tangent(lens, port, width, height, T(-lowest_))) {}

  FlatPortCamera() = default;  // means nothing before each_field() has filled it

  // Calls visit(field) with every number the camera consists of, in a fixed order: how cameras are
  // dealt to SIMD lanes. One of them is an int, the number of projection steps: lanes that work
  // together take the largest.
  template <class Visit>
  void each_field(Visit&& visit) {
    visit(lens_.fx), visit(lens_.fy), visit(lens_.cx), visit(lens_.cy);
    visit(inv_fx_), visit(inv_fy_);
    visit(port_.normal.x()), visit(port_.normal.y()), visit(port_.normal.z());
    visit(port_.distance), visit(port_.thickness);
    visit(port_.n_air), visit(port_.n_glass), visit(port_.n_water);
    visit(optics_.distance), visit(optics_.thickness);
    for (Medium<T>* medium : {&optics_.glass, &optics_.water})
      visit(medium->b), visit(medium->c), visit(medium->inv_mu);
    visit(lowest_), visit(highest_u_), visit(highest_v_);
    visit(field_.offset), visit(field_.slope), visit(field_.inv_largest_tangent);
    visit(field_.halley_steps);
  }

  const PinholeLens<T>& lens() const { return lens_; }
  const FlatPort<T>& port() const { return port_; }
  const FlatPortOptics<T>& optics() const { return optics_; }
  Matrix3<T> rotation_to_axis() const { return axis_from_camera(port_.normal); }

  // The ray in water. Its origin is the virtual centre C_v on the axis. A pixel that looks along or
  // away from the port has no ray in water: the result is then a grazing ray, finite, and its
  // Jacobian finite without meaning. NaN in, NaN out.
  AxialRay<T> ray(const Vector2<T>& pixel) const {
    using std::sqrt;
    const Vector3<T> across = air_direction(pixel).across;
    const T s = across.squaredNorm();
    const T inv_qw = T(1) / optics_.water.q(s);
    // |(across / q_w, 1)| in the axis frame
    const T inv_norm = T(1) / sqrt(s * inv_qw * inv_qw + T(1));
    return {port_.normal * optics_.virtual_centre(s),
            (inv_qw * inv_norm) * across + inv_norm * port_.normal};
  }

  AxialRay<T> ray(const Vector2<T>& pixel, AxialRayJacobian<T>& jacobian) const;

  // The point where the pixel's light leaves the glass into the water, in the camera frame.
  Vector3<T> exit_point(const Vector2<T>& pixel) const {
    const Vector3<T> across = air_direction(pixel).across;
    const T k = optics_.distance + optics_.thickness / optics_.glass.q(across.squaredNorm());
    return k * across + optics_.outer() * port_.normal;
  }

  // Exact forward projection of X [camera frame]. Not visible: on the lens's side of the outer
  // plane, outside the widened image, beyond total reflection, or NaN; pixel and Jacobian are then
  // finite and mean nothing. `origin`: where the ray through X begins, the virtual centre C_v.
  Projection<T> project(const Vector3<T>& X, Matrix23<T>* jacobian = nullptr,
                        Vector3<T>* origin = nullptr) const;

 private:
  // A pixel's direction in air is n + across, with `across` at right angles to the normal n.
  struct AirDirection {
    Vector3<T> across;
    T inv_along;  // scale from the lens's bearing (z = 1)
  };

  static int margin_or_default(int width, int height, int margin) {
    return margin >= 0 ? margin : (width > height ? width : height) / 8;
  }

  AirDirection air_direction(const Vector2<T>& pixel) const {
    const Vector3<T> bearing((pixel.x() - lens_.cx) * inv_fx_, (pixel.y() - lens_.cy) * inv_fy_,
                             T(1));
    const T along = bearing.dot(port_.normal);
    const T inv = T(1) / select(along < T(1e-3), T(1e-3), along);
    return {(bearing - along * port_.normal) * inv, inv};
  }

  Mask<T> inside_widened_image(const Vector2<T>& pixel) const {
    return pixel.x() >= lowest_ && pixel.x() <= highest_u_ && pixel.y() >= lowest_ &&
           pixel.y() <= highest_v_;
  }

  PinholeLens<T> lens_;
  T inv_fx_, inv_fy_;
  FlatPort<T> port_;
  FlatPortOptics<T> optics_;
  T lowest_, highest_u_, highest_v_;  // the widened image
  FlatPortField<T> field_;
};

template <class T>
AxialRay<T> FlatPortCamera<T>::ray(const Vector2<T>& pixel, AxialRayJacobian<T>& jacobian) const {
  using std::sqrt;
  const Vector3<T>& n = port_.normal;
  const AirDirection air = air_direction(pixel);
  const Vector3<T>& a = air.across;
  const T s = a.squaredNorm();
  const T inv_qw = T(1) / optics_.water.q(s);
  const T inv_qg = T(1) / optics_.glass.q(s);
  const T q_w = optics_.water.q(s);
  const T glass_term = optics_.thickness * inv_qg;
  const T inv_norm = T(1) / sqrt(s * inv_qw * inv_qw + T(1));
  const Vector3<T> direction = (inv_qw * inv_norm) * a + inv_norm * n;

  // d/ds of q_w, of the height of C_v, and of 1/q_w.
  const T dqw = T(0.5) * optics_.water.c * inv_qw;
  const T dz = T(0.5) * glass_term * inv_qg * inv_qg * optics_.glass.c * q_w -
               (optics_.distance + glass_term) * dqw;
  const T dinv = -dqw * inv_qw * inv_qw;
  for (int k = 0; k < 2; ++k) {
    // The bearing's derivative is (1/fx, 0, 0) or (0, 1/fy, 0); n + a is the bearing / (n.bearing).
    const T step = (k == 0 ? inv_fx_ : inv_fy_) * air.inv_along;
    Vector3<T> da = -(n(k) * step) * (n + a);
    da(k) += step;
    const T ds = T(2) * a.dot(da);
    const Vector3<T> dw = inv_qw * da + (dinv * ds) * a;
    jacobian.origin.col(k) = n * (dz * ds);
    jacobian.direction.col(k) = (dw - direction * direction.dot(dw)) * inv_norm;
  }
  return {n * (optics_.outer() - (optics_.distance + glass_term) * q_w), direction};
}

template <class T>
Projection<T> FlatPortCamera<T>::project(const Vector3<T>& X, Matrix23<T>* jacobian,
                                         Vector3<T>* origin) const {
  const Vector3<T>& n = port_.normal;
  const T height = n.dot(X);
  Vector3<T> across = X - height * n;
  T z_water = height - optics_.outer();
  T rho2 = across.squaredNorm();
  const Mask<T> in_field = field_.contains(rho2, z_water);
  // Outside, a harmless point on the axis keeps everything below finite.
  for (int k = 0; k < 3; ++k) across(k) = select(in_field, across(k), T(0));
  z_water = select(in_field, z_water, T(1));
  rho2 = select(in_field, rho2, T(0));
  const FlatPortRoot<T> at = solve_projection(optics_, field_, rho2, z_water);
  const T& m = at.m;
  const Vector3<T> bearing = n + m * across;
  const Mask<T> in_front = bearing.z() > T(1e-3);
  const T inv_z = T(1) / select(in_front, bearing.z(), T(1));
  const T x = bearing.x() * inv_z;
  const T y = bearing.y() * inv_z;
  const Vector2<T> pixel(lens_.fx * x + lens_.cx, lens_.fy * y + lens_.cy);

  if (jacobian) {
    // With a = `across` and m_r = dt/d(rho): d(bearing)/dX = m (I - n n^T) + (m_r - m)/rho^2 a a^T
    // - (m m_r/q_w) a n^T, each row of the lens's Jacobian times that.
    const T m_r = T(1) / at.tangent;
    const T stretch = m_r * m * m * m * at.spread;
    const T slope = m * m_r * at.inv_qw;
    for (int row = 0; row < 2; ++row) {
      const T f = (row == 0 ? lens_.fx : lens_.fy) * inv_z;
      const T fz = -f * (row == 0 ? x : y);
      const T radial = f * across(row) + fz * across.z();
      const T along_a = stretch * radial;
      const T along_n = -slope * radial - m * (f * n(row) + fz * n.z());
      const T straight = m * f;
      (*jacobian)(row, 0) = along_a * across.x() + along_n * n.x() + (row == 0 ? straight : T(0));
      (*jacobian)(row, 1) = along_a * across.y() + along_n * n.y() + (row == 1 ? straight : T(0));
      (*jacobian)(row, 2) = along_a * across.z() + along_n * n.z() + m * fz;
    }
  }
  // In water the ray rises q_w/t for every metre that it leaves the axis.
  if (origin) *origin = (height - T(1) / (m * at.inv_qw)) * n;
  return {pixel, in_field && in_front && inside_widened_image(pixel)};
}

}  // namespace axial::refractive
