// SPDX-License-Identifier: BSD-3-Clause
// A pinhole lens behind a flat port: the exact axial camera. The ray of a pixel has a closed form.
// The projection of a point is the root of one scalar equation (flat_port_solver.h). The
// derivatives of rays and projections have closed forms.
//
// Let n be the unit normal of the port. Rays are computed in the camera frame. Where formulas in
// the axis frame (flat_port.h) use the x and y of a vector v, the code uses v - (n.v) n, the
// component of v perpendicular to n. Projections are computed in the port's frame
// (flat_port_projector.h).
#pragma once

#include <cmath>

#include "refractive/flat_port.h"
#include "refractive/flat_port_projector.h"
#include "refractive/pinhole_camera.h"

namespace axial::refractive {

// `T` is float, a SIMD pack of floats, double or an automatic-differentiation scalar. In single
// precision, project() takes a fixed number of solver steps without branches. With all other
// scalars, project() iterates to convergence.
template <class T>
class FlatPortCamera {
 public:
  using Scalar = T;

  // `lens`: the lens in air. `width`, `height`: size of the image [px]. `margin` [px]: the image is
  // widened by this margin on every side. A negative margin stands for an eighth of the longer
  // side, rounded down. Points whose images lie outside the widened image are not visible (see
  // project()). The preconditions of FlatPort are not checked.
  FlatPortCamera(const PinholeLens<T>& lens, const FlatPort<T>& port, int width, int height,
                 int margin = -1)
      : lens_(lens),
        inv_fx_(T(1) / lens.fx),
        inv_fy_(T(1) / lens.fy),
        port_(port),
        optics_(port),
        rotation_to_axis_(axis_from_camera(port.normal)),
        projector_(lens, port, width, height,
                   WidenedImage<T>::margin_or_default(width, height, margin)) {}

  // The camera with a given field and a given image rectangle. A point is visible only if `field`
  // contains the point and `image` [px] contains the pixel of the point. Precondition: `field` was
  // computed for `port`.
  FlatPortCamera(const PinholeLens<T>& lens, const FlatPort<T>& port, const FlatPortField<T>& field,
                 const WidenedImage<T>& image)
      : lens_(lens),
        inv_fx_(T(1) / lens.fx),
        inv_fy_(T(1) / lens.fy),
        port_(port),
        optics_(port),
        rotation_to_axis_(axis_from_camera(port.normal)),
        projector_(lens, port, field, image) {}

  FlatPortCamera() = default;  // invalid until each_field() has filled it

  // Calls visit(number) for every number of the camera, in a fixed order. The SIMD code uses this
  // function to copy several cameras into the lanes of one camera. All numbers have the type T,
  // except the number of solver steps of the projection, which is an int. If the cameras in the
  // lanes have different numbers of steps, all lanes take the largest of these numbers.
  template <class Visit>
  void each_field(Visit&& visit) {
    visit(lens_.fx), visit(lens_.fy), visit(lens_.cx), visit(lens_.cy);
    visit(inv_fx_), visit(inv_fy_);
    visit(port_.normal.x()), visit(port_.normal.y()), visit(port_.normal.z());
    visit(port_.distance), visit(port_.thickness);
    visit(port_.n_air), visit(port_.n_glass), visit(port_.n_water);
    optics_.each_field(visit);
    for (int k = 0; k < 9; ++k) visit(rotation_to_axis_(k));
    projector_.each_field(visit);
  }

  const PinholeLens<T>& lens() const { return lens_; }
  const FlatPort<T>& port() const { return port_; }
  const FlatPortOptics<T>& optics() const { return optics_; }

  // The rotation from the camera frame to the axis frame (flat_port.h), as axis_from_camera()
  // returns it. The frames of virtual cameras (virtual_camera.h) have the same rotation.
  const Matrix3<T>& rotation_to_axis() const { return rotation_to_axis_; }

  // The ray of `pixel` in water, in the camera frame. The origin of the ray is the virtual centre
  // C_v on the axis. A pixel has no ray in water if its direction in air is nearly parallel to the
  // port or points away from the port. The result is then a finite grazing ray. A NaN pixel gives a
  // NaN ray.
  AxialRay<T> ray(const Vector2<T>& pixel) const {
    using std::sqrt;
    const Vector3<T> across = air_direction(pixel).across;
    const T s = across.squaredNorm();
    const T inv_qw = T(1) / optics_.water.q(s);
    // The inverse of the length of (across / q_w, 1), the direction in the axis frame.
    const T inv_norm = T(1) / sqrt(s * inv_qw * inv_qw + T(1));
    return {port_.normal * optics_.virtual_centre(s),
            (inv_qw * inv_norm) * across + inv_norm * port_.normal};
  }

  // The ray of `pixel`, as above. `jacobian` receives the derivatives of the ray by the pixel. They
  // are finite but meaningless if the pixel has no ray in water.
  AxialRay<T> ray(const Vector2<T>& pixel, AxialRayJacobian<T>& jacobian) const;

  // The point at which the ray of `pixel` crosses the outer plane, between glass and water [camera
  // frame, m]. The point is finite but meaningless if the pixel has no ray in water.
  Vector3<T> exit_point(const Vector2<T>& pixel) const {
    const Vector3<T> across = air_direction(pixel).across;
    const T k = optics_.distance + optics_.thickness / optics_.glass.q(across.squaredNorm());
    return k * across + optics_.outer() * port_.normal;
  }

  // The part of the camera that projects points. It takes points in the port's frame
  // (flat_port_projector.h). projector_frame() is the transformation from the camera frame to the
  // port's frame.
  using Projector = FlatPortProjector<T>;
  const Projector& projector() const { return projector_; }
  RigidTransform<T> projector_frame() const {
    return {rotation_to_axis_, Vector3<T>(T(0), T(0), -optics_.outer())};
  }

  // Exact forward projection of X [camera frame, m]. `jacobian` receives d(pixel)/dX [px/m].
  // `origin` receives the origin of the ray through X, which is the virtual centre C_v of this ray
  // [camera frame, m]. Both pointers may be null.
  //
  // X is not visible in any of these cases:
  //   - X lies on the lens's side of the outer plane.
  //   - The image of X lies outside the widened image, or the light from X comes from behind the
  //     lens.
  //   - No ray of the camera's field reaches X, for example because of total reflection.
  //   - X is NaN.
  //   - The distance of X to the outer plane is 0.1 mm or less, or 100 km or more, in single
  //     precision. For all other scalars the limits are 1 nm and a million kilometres.
  // The pixel, the Jacobian and the origin of a point that is not visible are finite but
  // meaningless.
  Projection<T> project(const Vector3<T>& X, Matrix23<T>* jacobian = nullptr,
                        Vector3<T>* origin = nullptr) const;

 private:
  // A pixel's direction in air, scaled to n + across, where `across` is perpendicular to the normal
  // n.
  struct AirDirection {
    Vector3<T> across;
    T inv_along;  // n + across = inv_along * bearing, where the bearing has z = 1
  };

  AirDirection air_direction(const Vector2<T>& pixel) const {
    const Vector3<T> bearing((pixel.x() - lens_.cx) * inv_fx_, (pixel.y() - lens_.cy) * inv_fy_,
                             T(1));
    const T along = bearing.dot(port_.normal);
    const T inv = T(1) / select(along < T(1e-3), T(1e-3), along);
    return {(bearing - along * port_.normal) * inv, inv};
  }

  PinholeLens<T> lens_;
  T inv_fx_, inv_fy_;
  FlatPort<T> port_;
  FlatPortOptics<T> optics_;
  Matrix3<T> rotation_to_axis_;
  FlatPortProjector<T> projector_;
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

  // Derivatives by s: of q_w, of the height of C_v, and of 1/q_w.
  const T dqw = T(0.5) * optics_.water.c * inv_qw;
  const T dz = T(0.5) * glass_term * inv_qg * inv_qg * optics_.glass.c * q_w -
               (optics_.distance + glass_term) * dqw;
  const T dinv = -dqw * inv_qw * inv_qw;
  for (int k = 0; k < 2; ++k) {
    // The derivative of the bearing is (1/fx, 0, 0) or (0, 1/fy, 0), and
    // n + a = bearing / (n.bearing).
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
  Vector3<T> in_port = rotation_to_axis_ * X;
  in_port.z() -= optics_.outer();
  const FlatPortImage<T> image = projector_.image(in_port);
  if (jacobian)
    for (int k = 0; k < 3; ++k) jacobian->col(k) = image.pixel_motion(rotation_to_axis_.col(k));
  if (origin) *origin = (image.origin_height + optics_.outer()) * port_.normal;
  return image.projection;
}

}  // namespace axial::refractive
