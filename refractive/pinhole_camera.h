// SPDX-License-Identifier: GPL-3.0-or-later
// Pinhole lens and the camera without a port.
#pragma once

#include <cmath>

#include "refractive/axial_ray.h"

namespace axial::refractive {

// In-air pinhole intrinsics in pixels: u = fx x/z + cx, v = fy y/z + cy, pixel centres at integers.
template <class T>
struct PinholeLens {
  T fx, fy, cx, cy;

  template <class U>
  PinholeLens<U> cast() const {
    return {static_cast<U>(fx), static_cast<U>(fy), static_cast<U>(cx), static_cast<U>(cy)};
  }

  // The viewing direction in air of a pixel, scaled to z = 1.
  Vector3<T> bearing(const Vector2<T>& pixel) const {
    return {(pixel.x() - cx) / fx, (pixel.y() - cy) / fy, T(1)};
  }

  // The pixel of an in-air direction with z > 0.
  Vector2<T> pixel(const Vector3<T>& bearing_in_camera) const {
    return {fx * bearing_in_camera.x() / bearing_in_camera.z() + cx,
            fy * bearing_in_camera.y() / bearing_in_camera.z() + cy};
  }

  // d(pixel)/d(direction) of `pixel()`.
  Matrix23<T> pixel_jacobian(const Vector3<T>& b) const {
    const T inv_z = T(1) / b.z();
    Matrix23<T> jacobian;
    jacobian << fx * inv_z, T(0), -fx * b.x() * inv_z * inv_z,  //
        T(0), fy * inv_z, -fy * b.y() * inv_z * inv_z;
    return jacobian;
  }
};

// A dry camera: all rays start at the centre. A point is visible when it is in front (z > 0) and
// not absurdly far to the side; it has no image rectangle to test against.
template <class T>
class PinholeCamera {
 public:
  using Scalar = T;

  PinholeCamera() = default;  // means nothing before each_field() has filled it
  explicit PinholeCamera(const PinholeLens<T>& lens) : lens_(lens) {}

  // Calls visit(field) with every number the camera consists of, in a fixed order: how cameras are
  // dealt to SIMD lanes.
  template <class Visit>
  void each_field(Visit&& visit) {
    visit(lens_.fx), visit(lens_.fy), visit(lens_.cx), visit(lens_.cy);
  }

  const PinholeLens<T>& lens() const { return lens_; }

  AxialRay<T> ray(const Vector2<T>& pixel) const {
    using std::sqrt;
    const Vector3<T> bearing = lens_.bearing(pixel);
    return {Vector3<T>::Zero(), bearing * (T(1) / sqrt(bearing.squaredNorm()))};
  }

  AxialRay<T> ray(const Vector2<T>& pixel, AxialRayJacobian<T>& jacobian) const {
    using std::sqrt;
    const Vector3<T> bearing = lens_.bearing(pixel);
    const T inv_norm = T(1) / sqrt(bearing.squaredNorm());
    const Vector3<T> direction = bearing * inv_norm;
    const Vector3<T> du{inv_norm / lens_.fx, T(0), T(0)};
    const Vector3<T> dv{T(0), inv_norm / lens_.fy, T(0)};
    jacobian.origin.setZero();
    jacobian.direction.col(0) = du - direction * direction.dot(du);
    jacobian.direction.col(1) = dv - direction * direction.dot(dv);
    return {Vector3<T>::Zero(), direction};
  }

  // The last point of the light's path in the scene's medium, in the camera frame.
  Vector3<T> exit_point(const Vector2<T>&) const { return Vector3<T>::Zero(); }

  // Where X is not visible, pixel and Jacobian are finite and mean nothing.
  Projection<T> project(const Vector3<T>& X, Matrix23<T>* jacobian = nullptr,
                        Vector3<T>* origin = nullptr) const {
    using std::abs;
    // False for NaN; the bounds keep pixel and Jacobian within single precision.
    const T widest = T(1e6) * X.z();
    const Mask<T> visible =
        X.z() > T(1e-20) && X.z() < T(1e20) && abs(X.x()) <= widest && abs(X.y()) <= widest;
    const Vector3<T> safe(select(visible, X.x(), T(0)), select(visible, X.y(), T(0)),
                          select(visible, X.z(), T(1)));
    if (jacobian) *jacobian = lens_.pixel_jacobian(safe);
    if (origin) *origin = {T(0), T(0), T(0)};
    return {lens_.pixel(safe), visible};
  }

 private:
  PinholeLens<T> lens_;
};

}  // namespace axial::refractive
