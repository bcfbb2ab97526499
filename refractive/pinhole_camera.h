// SPDX-License-Identifier: BSD-3-Clause
// A pinhole lens, and the camera that has this lens and no port.
#pragma once

#include <cmath>

#include "refractive/axial_ray.h"

namespace axial::refractive {

// Pinhole intrinsics in air, in pixels: u = fx x/z + cx, v = fy y/z + cy. Pixel centres lie at
// integers.
template <class T>
struct PinholeLens {
  T fx, fy, cx, cy;

  template <class U>
  PinholeLens<U> cast() const {
    return {static_cast<U>(fx), static_cast<U>(fy), static_cast<U>(cx), static_cast<U>(cy)};
  }

  // The direction in air of a pixel, scaled to z = 1.
  Vector3<T> bearing(const Vector2<T>& pixel) const {
    return {(pixel.x() - cx) / fx, (pixel.y() - cy) / fy, T(1)};
  }

  // The pixel of a direction in air. Precondition: z > 0.
  Vector2<T> pixel(const Vector3<T>& bearing_in_camera) const {
    return {fx * bearing_in_camera.x() / bearing_in_camera.z() + cx,
            fy * bearing_in_camera.y() / bearing_in_camera.z() + cy};
  }
};

// The image of a point, and the derivative of the pixel by the point. Points are in the camera
// frame.
template <class T>
struct PinholeImage {
  Projection<T> projection;

  // The origin of the ray through the point: the camera centre.
  Vector3<T> origin() const { return {T(0), T(0), T(0)}; }

  // First-order motion of the pixel [px] when the point moves by `step` [camera frame, m].
  Vector2<T> pixel_motion(const Vector3<T>& step) const {
    return {scale_u * (step.x() - x * step.z()), scale_v * (step.y() - y * step.z())};
  }

  T x, y;              // x and y of the point, divided by z
  T scale_u, scale_v;  // fx/z and fy/z [px/m]
};

// A camera without a port: all rays start at the camera centre. A point (x, y, z) [camera frame, m]
// is visible if 1e-20 < z < 1e20, |x| <= 1e6 z and |y| <= 1e6 z. There is no test against an image
// rectangle.
template <class T>
class PinholeCamera {
 public:
  using Scalar = T;

  PinholeCamera() = default;  // invalid until each_field() has filled it
  explicit PinholeCamera(const PinholeLens<T>& lens) : lens_(lens) {}

  // Calls visit(number) for every number of the camera, in a fixed order. The SIMD code uses it as
  // it uses FlatPortCamera::each_field().
  template <class Visit>
  void each_field(Visit&& visit) {
    visit(lens_.fx), visit(lens_.fy), visit(lens_.cx), visit(lens_.cy);
  }

  const PinholeLens<T>& lens() const { return lens_; }

  // The ray of `pixel` in the camera frame. A NaN pixel gives a NaN direction.
  AxialRay<T> ray(const Vector2<T>& pixel) const {
    using std::sqrt;
    const Vector3<T> bearing = lens_.bearing(pixel);
    return {Vector3<T>::Zero(), bearing * (T(1) / sqrt(bearing.squaredNorm()))};
  }

  // The ray of `pixel`, as above. `jacobian` receives the derivatives of the ray by the pixel.
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

  // The start of the pixel's ray in the scene medium: the camera centre.
  Vector3<T> exit_point(const Vector2<T>&) const { return Vector3<T>::Zero(); }

  // The projector is the camera itself. It takes points in the camera frame.
  using Projector = PinholeCamera;
  const Projector& projector() const { return *this; }
  RigidTransform<T> projector_frame() const { return {Matrix3<T>::Identity(), Vector3<T>::Zero()}; }

  // The image of X [camera frame, m]. If X is not visible, the numbers of the result are finite but
  // meaningless.
  PinholeImage<T> image(const Vector3<T>& X) const {
    using std::abs;
    PinholeImage<T> image;
    // False for NaN. The bounds keep pixel and derivatives within the range of single precision.
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

  // Projects X [camera frame, m]. `jacobian` receives d(pixel)/dX [px/m]. `origin` receives the
  // origin of the ray through X, which is the camera centre. Both pointers may be null. If X is not
  // visible, the numbers are finite but meaningless.
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
