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
};

// A point's image and how it moves with the point.
template <class T>
struct PinholeImage {
  Projection<T> projection;

  // Where the ray through the point begins.
  Vector3<T> origin() const { return {T(0), T(0), T(0)}; }

  // The pixel's motion [px] with a motion of the point [m], to first order.
  Vector2<T> moved(const Vector3<T>& step) const {
    return {scale_u * (step.x() - x * step.z()), scale_v * (step.y() - y * step.z())};
  }

  T x, y;              // the point divided by its z
  T scale_u, scale_v;  // focal lengths divided by z
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

  // What projects, and its frame: the camera itself.
  using Projector = PinholeCamera;
  const Projector& projector() const { return *this; }
  Frame<T> projector_frame() const { return {Matrix3<T>::Identity(), Vector3<T>::Zero()}; }

  // Where X is not visible, the pixel and its motions are finite and mean nothing.
  PinholeImage<T> image(const Vector3<T>& X) const {
    using std::abs;
    PinholeImage<T> image;
    // False for NaN; the bounds keep pixel and motions within single precision.
    const T widest = T(1e6) * X.z();
    image.projection.visible =
        X.z() > T(1e-20) && X.z() < T(1e20) && abs(X.x()) <= widest && abs(X.y()) <= widest;
    const Mask<T>& visible = image.projection.visible;
    const T inv_z = T(1) / select(visible, X.z(), T(1));
    image.x = select(visible, X.x(), T(0)) * inv_z;
    image.y = select(visible, X.y(), T(0)) * inv_z;
    image.scale_u = lens_.fx * inv_z;
    image.scale_v = lens_.fy * inv_z;
    image.projection.pixel = {lens_.fx * image.x + lens_.cx, lens_.fy * image.y + lens_.cy};
    return image;
  }

  Projection<T> project(const Vector3<T>& X, Matrix23<T>* jacobian = nullptr,
                        Vector3<T>* origin = nullptr) const {
    const PinholeImage<T> image = this->image(X);
    if (jacobian)
      *jacobian << image.scale_u, T(0), -image.scale_u * image.x,  //
          T(0), image.scale_v, -image.scale_v * image.y;
    if (origin) *origin = {T(0), T(0), T(0)};
    return image.projection;
  }

 private:
  PinholeLens<T> lens_;
};

}  // namespace axial::refractive
