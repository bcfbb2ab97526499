// SPDX-License-Identifier: BSD-3-Clause
// A pinhole lens behind a dome port: the exact axial camera. C_v and C are defined in dome_port.h.
// The ray of a pixel has a closed form.
// The projection of a point is the root of one scalar equation (dome_port_projector.h). The axis
// runs through the camera centre and the centre of the dome. A dome that is centred on the camera
// centre does not refract.
#pragma once

#include <cmath>

#include "refractive/dome_port.h"
#include "refractive/dome_port_projector.h"
#include "refractive/pinhole_camera.h"

namespace axial::refractive {

// `T` is float, a SIMD pack of floats, double or an automatic-differentiation scalar. In single
// precision, project() takes a fixed number of solver steps without branches. With all other
// scalars, project() iterates to convergence.
template <class T>
class DomePortCamera {
 public:
  using Scalar = T;

  // `lens`: the lens in air. `width`, `height`: size of the image [px]. `margin` [px]: the image is
  // widened by this margin on every side. A negative margin stands for an eighth of the longer
  // side, rounded down. Points whose images lie outside the widened image are not visible (see
  // project()). The preconditions of DomePort are not checked.
  DomePortCamera(const PinholeLens<T>& lens, const DomePort<T>& port, int width, int height,
                 int margin = -1)
      : DomePortCamera(lens, port,
                       WidenedImage<T>(width, height,
                                       WidenedImage<T>::margin_or_default(width, height, margin))) {
  }

  // The camera with a given image rectangle. A point is visible only if `image` [px] contains the
  // pixel of the point.
  DomePortCamera(const PinholeLens<T>& lens, const DomePort<T>& port, const WidenedImage<T>& image)
      : lens_(lens),
        inv_fx_(T(1) / lens.fx),
        inv_fy_(T(1) / lens.fy),
        projector_(lens, port, image) {}

  DomePortCamera() = default;  // invalid until each_field() has filled it

  // Calls visit(number) for every number of the camera, in a fixed order. The SIMD code uses it as
  // it uses FlatPortCamera::each_field().
  template <class Visit>
  void each_field(Visit&& visit) {
    visit(lens_.fx), visit(lens_.fy), visit(lens_.cx), visit(lens_.cy);
    visit(inv_fx_), visit(inv_fy_);
    projector_.each_field(visit);
  }

  const PinholeLens<T>& lens() const { return lens_; }
  const DomePortOptics<T>& optics() const { return projector_.optics(); }

  // The rotation from the camera frame to the frame of virtual cameras (virtual_camera.h): the
  // identity. Virtual cameras behind a dome look along the optical axis of the lens and not along
  // the axis of the dome, because the axis of the dome may have any direction.
  Matrix3<T> rotation_to_axis() const { return Matrix3<T>::Identity(); }

  // The ray of `pixel` in water, in the camera frame. The origin of the ray is the virtual centre
  // C_v on the axis. A NaN pixel gives a NaN ray.
  AxialRay<T> ray(const Vector2<T>& pixel) const {
    AxialRayJacobian<T> unused;
    return ray(pixel, unused);
  }

  // The ray of `pixel`, as above. `jacobian` receives the derivatives of the ray by the pixel.
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
      // The derivative of the bearing is (1/fx, 0, 0) or (0, 1/fy, 0).
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

  // The point at which the ray of `pixel` crosses the outer sphere, between glass and water
  // [camera frame, m].
  Vector3<T> exit_point(const Vector2<T>& pixel) const {
    using std::sqrt;
    const AxialRay<T> ray = this->ray(pixel);
    const Vector3<T> from_centre = ray.origin - optics().centre;
    const T back = from_centre.dot(ray.direction);
    const T outer2 = optics().outer_radius * optics().outer_radius;
    return ray.at(sqrt(back * back + outer2 - from_centre.squaredNorm()) - back);
  }

  // The part of the camera that projects points. It takes points in the camera frame. So
  // projector_frame() is the identity.
  using Projector = DomePortProjector<T>;
  const Projector& projector() const { return projector_; }
  RigidTransform<T> projector_frame() const { return {Matrix3<T>::Identity(), Vector3<T>::Zero()}; }

  // Exact forward projection of X [camera frame, m]. `jacobian` receives d(pixel)/dX [px/m].
  // `origin` receives the origin of the ray through X, which is the virtual centre C_v of this ray
  // [camera frame, m]. Both pointers may be null.
  //
  // X is not visible in any of these cases:
  //   - X lies inside the outer sphere of the dome.
  //   - The image of X lies outside the widened image, or the light from X comes from behind the
  //     lens.
  //   - X is a million kilometres or more away from the centre of the dome.
  //   - X is NaN.
  // The pixel, the Jacobian and the origin of a point that is not visible are finite but
  // meaningless.
  Projection<T> project(const Vector3<T>& X, Matrix23<T>* jacobian = nullptr,
                        Vector3<T>* origin = nullptr) const {
    const DomePortImage<T> image = projector_.image(X);
    if (jacobian)
      for (int k = 0; k < 3; ++k) jacobian->col(k) = image.pixel_motion(Vector3<T>::Unit(k));
    if (origin) *origin = image.origin();
    return image.projection;
  }

 private:
  PinholeLens<T> lens_;
  T inv_fx_, inv_fy_;
  DomePortProjector<T> projector_;
};

}  // namespace axial::refractive
