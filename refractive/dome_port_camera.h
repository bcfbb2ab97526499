// SPDX-License-Identifier: GPL-3.0-or-later
// A pinhole lens behind a dome port: the exact axial camera, in closed form from pixel to ray. Its
// axis runs through the camera centre and the dome's; a centred dome bends nothing.
#pragma once

#include <cmath>

#include "refractive/dome_port.h"
#include "refractive/dome_port_projector.h"
#include "refractive/pinhole_camera.h"

namespace axial::refractive {

// `T` is float, double or an automatic-differentiation scalar. Float runs a fixed number of
// steps without branches; every other scalar iterates to convergence.
template <class T>
class DomePortCamera {
 public:
  using Scalar = T;

  // width, height: the image in pixels. Points are projected within the image widened by `margin`
  // pixels on every side (default: an eighth of the longer side).
  DomePortCamera(const PinholeLens<T>& lens, const DomePort<T>& port, int width, int height,
                 int margin = -1)
      : DomePortCamera(lens, port,
                       WidenedImage<T>(width, height,
                                       WidenedImage<T>::margin_or_default(width, height, margin))) {
  }

  // The same for points within `image` [px].
  DomePortCamera(const PinholeLens<T>& lens, const DomePort<T>& port, const WidenedImage<T>& image)
      : lens_(lens),
        inv_fx_(T(1) / lens.fx),
        inv_fy_(T(1) / lens.fy),
        projector_(lens, port, image) {}

  DomePortCamera() = default;  // means nothing before each_field() has filled it

  // As FlatPortCamera::each_field.
  template <class Visit>
  void each_field(Visit&& visit) {
    visit(lens_.fx), visit(lens_.fy), visit(lens_.cx), visit(lens_.cy);
    visit(inv_fx_), visit(inv_fy_);
    projector_.each_field(visit);
  }

  const PinholeLens<T>& lens() const { return lens_; }
  const DomePortOptics<T>& optics() const { return projector_.optics(); }

  // How virtual cameras are turned: as the lens is, because the axis may point anywhere.
  Matrix3<T> rotation_to_axis() const { return Matrix3<T>::Identity(); }

  // The ray in water. Its origin is the virtual centre C_v on the axis. NaN in, NaN out.
  AxialRay<T> ray(const Vector2<T>& pixel) const {
    AxialRayJacobian<T> unused;
    return ray(pixel, unused);
  }

  AxialRay<T> ray(const Vector2<T>& pixel, AxialRayJacobian<T>& jacobian) const {
    using std::sqrt;
    const Vector3<T>& C = optics().centre;
    const Vector3<T> bearing((pixel.x() - lens_.cx) * inv_fx_, (pixel.y() - lens_.cy) * inv_fy_,
                             T(1));
    const T inv_norm = T(1) / sqrt(bearing.squaredNorm());
    const Vector3<T> r = inv_norm * bearing;
    const T p = r.dot(C);
    const DomeTurn<T> turn = optics().turn(optics().centre2 - p * p);
    const T q = turn.cosine + p * turn.sine;
    const T shift = optics().inv_mu / q;
    for (int k = 0; k < 2; ++k) {
      // The bearing's derivative is (1/fx, 0, 0) or (0, 1/fy, 0).
      const T step = (k == 0 ? inv_fx_ : inv_fy_) * inv_norm;
      Vector3<T> dr = -(r(k) * step) * r;
      dr(k) += step;
      const T dp = C.dot(dr);
      const T dk2 = T(-2) * p * dp;
      const T dsine = turn.sine_slope * dk2;
      const T dq = turn.cosine_slope * dk2 + p * dsine + turn.sine * dp;
      jacobian.origin.col(k) = (shift * dq / q) * C;
      jacobian.direction.col(k) = q * dr + dq * r - dsine * C;
    }
    return {(T(1) - shift) * C, q * r - turn.sine * C};
  }

  // The point where the pixel's light leaves the glass into the water, in the camera frame.
  Vector3<T> exit_point(const Vector2<T>& pixel) const {
    using std::sqrt;
    const AxialRay<T> ray = this->ray(pixel);
    const Vector3<T> from_centre = ray.origin - optics().centre;
    const T back = from_centre.dot(ray.direction);
    const T outer2 = optics().outer_radius * optics().outer_radius;
    return ray.at(sqrt(back * back + outer2 - from_centre.squaredNorm()) - back);
  }

  // What projects, and its frame: the camera's own.
  using Projector = DomePortProjector<T>;
  const Projector& projector() const { return projector_; }
  Frame<T> projector_frame() const { return {Matrix3<T>::Identity(), Vector3<T>::Zero()}; }

  // Exact forward projection of X [camera frame]. Not visible: inside the dome, outside the
  // widened image, behind the lens, or NaN; pixel and Jacobian are then finite and mean nothing.
  // `origin`: where the ray through X begins, the virtual centre C_v.
  Projection<T> project(const Vector3<T>& X, Matrix23<T>* jacobian = nullptr,
                        Vector3<T>* origin = nullptr) const {
    const DomePortImage<T> image = projector_.image(X);
    if (jacobian)
      for (int k = 0; k < 3; ++k) jacobian->col(k) = image.moved(Vector3<T>::Unit(k));
    if (origin) *origin = image.origin();
    return image.projection;
  }

 private:
  PinholeLens<T> lens_;
  T inv_fx_, inv_fy_;
  DomePortProjector<T> projector_;
};

}  // namespace axial::refractive
