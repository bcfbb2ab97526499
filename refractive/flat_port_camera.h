// SPDX-License-Identifier: GPL-3.0-or-later
// A pinhole lens behind a flat port: the exact axial camera, in closed form both ways.
#pragma once

#include <cmath>
#include <type_traits>

#include "refractive/flat_port.h"
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
// pixels on every side. Corners that look away from the port (tilt and field of view beyond 90
// degrees) count as `kGrazing`.
template <class T>
T largest_incidence_tangent(const PinholeLens<T>& lens, const FlatPort<T>& port, int width,
                            int height, const T& margin) {
  using std::sqrt;
  const T kGrazing(50);  // 88.9 degrees
  T largest(0);
  for (const T& u : {-margin, T(width - 1) + margin}) {
    for (const T& v : {-margin, T(height - 1) + margin}) {
      const Vector3<T> bearing = lens.bearing({u, v});
      const T along = bearing.dot(port.normal);
      if (!(along > T(0))) return kGrazing;
      const T across = (bearing - along * port.normal).norm();
      const T tangent = across / along;
      if (tangent > largest) largest = tangent;
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

  // width, height: the image in pixels. The field within which points are projected is the image
  // widened by `margin` pixels on every side (default: an eighth of the longer side).
  FlatPortCamera(const PinholeLens<T>& lens, const FlatPort<T>& port, int width, int height,
                 int margin = -1)
      : lens_(lens),
        port_(port),
        optics_(port),
        axis_from_camera_(refractive::axis_from_camera(port.normal)),
        largest_tangent_(largest_incidence_tangent(
            lens, port, width, height,
            T(margin >= 0 ? margin : (width > height ? width : height) / 8))) {
    const T s = largest_tangent_ * largest_tangent_;
    field_offset_ = largest_tangent_ * (optics_.distance + optics_.thickness / optics_.glass.q(s));
    field_slope_ = largest_tangent_ / optics_.water.q(s);
  }

  const PinholeLens<T>& lens() const { return lens_; }
  const FlatPort<T>& port() const { return port_; }
  const FlatPortOptics<T>& optics() const { return optics_; }
  const Matrix3<T>& rotation_to_axis() const { return axis_from_camera_; }

  // The ray in water. Its origin is the virtual centre C_v on the axis. A pixel that looks along or
  // away from the port has no ray in water: the result is then the grazing ray, finite.
  AxialRay<T> ray(const Vector2<T>& pixel) const {
    const Vector3<T> m = air_direction(pixel);
    const T s = m.x() * m.x() + m.y() * m.y();
    const T inv_q = T(1) / optics_.water.q(s);
    const Vector3<T> direction = Vector3<T>(m.x() * inv_q, m.y() * inv_q, T(1)).normalized();
    return {port_.normal * optics_.virtual_centre(s), axis_from_camera_.transpose() * direction};
  }

  AxialRay<T> ray(const Vector2<T>& pixel, AxialRayJacobian<T>& jacobian) const;

  // The point where the pixel's light leaves the glass into the water, in the camera frame.
  Vector3<T> exit_point(const Vector2<T>& pixel) const {
    const Vector3<T> m = air_direction(pixel);
    const T s = m.x() * m.x() + m.y() * m.y();
    const T k = optics_.distance + optics_.thickness / optics_.glass.q(s);
    return axis_from_camera_.transpose() * Vector3<T>(m.x() * k, m.y() * k, optics_.outer());
  }

  // Exact forward projection of X [camera frame]. Not visible: behind the outer plane, outside the
  // widened image, beyond total reflection, or NaN.
  Projection<T> project(const Vector3<T>& X, Matrix23<T>* jacobian = nullptr) const;

 private:
  // In-air direction of a pixel in the axis frame, scaled to z = 1.
  Vector3<T> air_direction(const Vector2<T>& pixel) const {
    const Vector3<T> a = axis_from_camera_ * lens_.bearing(pixel);
    const T z = a.z() > T(1e-3) ? a.z() : T(1e-3);
    return {a.x() / z, a.y() / z, T(1)};
  }

  // Root t = tan(theta_air) of radius(t, z_water) = rho, for a point inside the field.
  T solve_tangent(const T& rho, const T& z_water) const;
  T halley_step(const T& t, const T& rho, const T& z_water) const;
  T newton_step(const T& t, const T& rho, const T& z_water) const;

  PinholeLens<T> lens_;
  FlatPort<T> port_;
  FlatPortOptics<T> optics_;
  Matrix3<T> axis_from_camera_;
  T largest_tangent_;
  T field_offset_;  // the field at height z_water: rho <= field_offset + field_slope * z_water
  T field_slope_;
};

template <class T>
AxialRay<T> FlatPortCamera<T>::ray(const Vector2<T>& pixel, AxialRayJacobian<T>& jacobian) const {
  using std::sqrt;
  const Vector3<T> a = axis_from_camera_ * lens_.bearing(pixel);
  const T z = a.z() > T(1e-3) ? a.z() : T(1e-3);
  const T inv_z = T(1) / z;
  const T x = a.x() * inv_z;
  const T y = a.y() * inv_z;

  // d(x, y)/d(u, v): the lens, the rotation, the division.
  Matrix2<T> dxy;
  const T inv_fx = T(1) / lens_.fx;
  const T inv_fy = T(1) / lens_.fy;
  dxy(0, 0) = (axis_from_camera_(0, 0) - x * axis_from_camera_(2, 0)) * inv_z * inv_fx;
  dxy(0, 1) = (axis_from_camera_(0, 1) - x * axis_from_camera_(2, 1)) * inv_z * inv_fy;
  dxy(1, 0) = (axis_from_camera_(1, 0) - y * axis_from_camera_(2, 0)) * inv_z * inv_fx;
  dxy(1, 1) = (axis_from_camera_(1, 1) - y * axis_from_camera_(2, 1)) * inv_z * inv_fy;

  const T s = x * x + y * y;
  const T q_g = optics_.glass.q(s);
  const T q_w = optics_.water.q(s);
  const T inv_qw = T(1) / q_w;
  const T inv_qg = T(1) / q_g;
  const Eigen::Matrix<T, 1, 2> ds = T(2) * (x * dxy.row(0) + y * dxy.row(1));
  const T dqw_ds = optics_.water.c * inv_qw / T(2);
  const T dqg_ds = optics_.glass.c * inv_qg / T(2);

  const T glass_term = optics_.thickness * inv_qg;
  const T dzv_ds = glass_term * inv_qg * q_w * dqg_ds - (optics_.distance + glass_term) * dqw_ds;
  jacobian.origin = port_.normal * (dzv_ds * ds);

  const Vector3<T> w(x * inv_qw, y * inv_qw, T(1));
  const T inv_norm = T(1) / sqrt(w.squaredNorm());
  const Vector3<T> direction = w * inv_norm;
  Matrix32<T> dw;
  const T shrink = dqw_ds * inv_qw * inv_qw;
  dw.row(0) = dxy.row(0) * inv_qw - x * shrink * ds;
  dw.row(1) = dxy.row(1) * inv_qw - y * shrink * ds;
  dw.row(2).setZero();
  const Matrix32<T> dd = (dw - direction * (direction.transpose() * dw)) * inv_norm;
  jacobian.direction = axis_from_camera_.transpose() * dd;

  const T z_v = optics_.outer() - (optics_.distance + glass_term) * q_w;
  return {port_.normal * z_v, axis_from_camera_.transpose() * direction};
}

template <class T>
T FlatPortCamera<T>::halley_step(const T& t, const T& rho, const T& z_water) const {
  const T s = t * t;
  const T inv_qg = T(1) / optics_.glass.q(s);
  const T inv_qw = T(1) / optics_.water.q(s);
  const T g = optics_.thickness * inv_qg;
  const T w = z_water * inv_qw;
  const T g3 = g * inv_qg * inv_qg * optics_.glass.b;
  const T w3 = w * inv_qw * inv_qw * optics_.water.b;
  const T f = t * (optics_.distance + g + w) - rho;
  const T f1 = optics_.distance + g3 + w3;
  const T f2 =
      T(-3) * t * (g3 * inv_qg * inv_qg * optics_.glass.c + w3 * inv_qw * inv_qw * optics_.water.c);
  return t - T(2) * f * f1 / (T(2) * f1 * f1 - f * f2);
}

template <class T>
T FlatPortCamera<T>::newton_step(const T& t, const T& rho, const T& z_water) const {
  const T s = t * t;
  const T inv_qg = T(1) / optics_.glass.q(s);
  const T inv_qw = T(1) / optics_.water.q(s);
  const T g = optics_.thickness * inv_qg;
  const T w = z_water * inv_qw;
  const T f = t * (optics_.distance + g + w) - rho;
  const T f1 = optics_.distance + g * inv_qg * inv_qg * optics_.glass.b +
               w * inv_qw * inv_qw * optics_.water.b;
  return t - f / f1;
}

template <class T>
T FlatPortCamera<T>::solve_tangent(const T& rho, const T& z_water) const {
  using std::sqrt;
  // The paraxial guess lies left of the root of an increasing concave function.
  T t = rho / (optics_.distance + optics_.thickness / sqrt(optics_.glass.b) +
               z_water / sqrt(optics_.water.b));
  if constexpr (std::is_same_v<T, float>) {
    for (int step = 0; step < 3; ++step) t = halley_step(t, rho, z_water);
  } else {
    // Newton rises monotonically to the root; a step that no longer rises is rounding. One Halley
    // step first saves about two of Newton's; one more after the stop carries derivatives of
    // automatic-differentiation scalars along.
    for (int step = 0; step < 60; ++step) {
      const T next = newton_step(t, rho, z_water);
      const bool rising = next > t;
      t = next;
      if (!rising) break;
    }
    t = newton_step(t, rho, z_water);
  }
  return t;
}

template <class T>
Projection<T> FlatPortCamera<T>::project(const Vector3<T>& X, Matrix23<T>* jacobian) const {
  using std::sqrt;
  Vector3<T> P = axis_from_camera_ * X;
  T z_water = P.z() - optics_.outer();
  T rho2 = P.x() * P.x() + P.y() * P.y();
  const T limit = field_offset_ + field_slope_ * z_water;
  const bool visible = z_water > T(0) && rho2 <= limit * limit;
  if (!visible) {  // a harmless point on the axis keeps everything below finite
    z_water = T(1);
    P = Vector3<T>(T(0), T(0), optics_.outer() + z_water);
    rho2 = T(0);
  }
  // sqrt at zero has no derivative; on the axis t and its derivative by rho are taken from rho =
  // 0+.
  const bool on_axis = !(rho2 > T(1e-30));
  const T rho = on_axis ? T(0) : sqrt(rho2);
  const T t = solve_tangent(rho, z_water);
  const T s = t * t;
  const T inv_qg = T(1) / optics_.glass.q(s);
  const T inv_qw = T(1) / optics_.water.q(s);
  const T g = optics_.thickness * inv_qg;
  const T w = z_water * inv_qw;
  const T m = T(1) / (optics_.distance + g + w);
  const Vector3<T> bearing = axis_from_camera_.transpose() * Vector3<T>(P.x() * m, P.y() * m, T(1));
  const bool in_front = bearing.z() > T(1e-6);
  const Vector3<T> safe = in_front ? bearing : Vector3<T>(T(0), T(0), T(1));

  if (jacobian) {
    const T m_r = T(1) / (optics_.distance + g * inv_qg * inv_qg * optics_.glass.b +
                          w * inv_qw * inv_qw * optics_.water.b);
    const T inv_rho = on_axis ? T(0) : T(1) / rho;
    const T ex = P.x() * inv_rho;
    const T ey = P.y() * inv_rho;
    const T k = on_axis ? T(0) : T(m_r - m);
    const T dz = -t * inv_qw * m_r;
    Matrix3<T> d;
    d << m + k * ex * ex, k * ex * ey, dz * ex,  //
        k * ex * ey, m + k * ey * ey, dz * ey,   //
        T(0), T(0), T(0);
    *jacobian =
        lens_.pixel_jacobian(safe) * (axis_from_camera_.transpose() * d * axis_from_camera_);
  }
  return {lens_.pixel(safe), visible && in_front};
}

}  // namespace axial::refractive
