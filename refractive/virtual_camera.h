// SPDX-License-Identifier: BSD-3-Clause
// The paper's virtual cameras. The virtual camera of a pixel of an axial camera is a pinhole. Its
// centre is C_v, the origin of the pixel's ray in water. It looks along the port's normal, or
// behind a dome along the optical axis of the lens. It has the focal lengths of the real lens
// (f_v = f). Its principal point is chosen so that the virtual camera images the pixel's ray at the
// same pixel (eq. 3, with the correction of the second component in docs/refraction.md).
//
// Poses: x_virtual = rotation * (x_camera - centre). For two views, x_source = R (x_reference - C),
// in the frames of the real cameras. Units: metres and pixels. Equation numbers are those of the
// paper that docs/refraction.md names.
#pragma once

#include "refractive/axial_ray.h"
#include "refractive/pinhole_camera.h"

namespace axial::refractive {

template <class T>
struct VirtualCamera {
  Vector3<T> centre;    // C_v [frame of the real camera, m]
  Matrix3<T> rotation;  // virtual_from_camera: from the real camera's frame to the virtual camera's
  PinholeLens<T> lens;  // f_v = f, principal point c_v [px]

  // The pixel of X [frame of the real camera, m]. Precondition: X lies in front of the virtual
  // camera.
  Vector2<T> pixel(const Vector3<T>& X) const { return lens.pixel(rotation * (X - centre)); }
};

// The principal point c_v [px] of a virtual camera (eq. 3, corrected). With this principal point,
// the virtual camera images the ray in water with the direction `direction` [frame of the real
// camera] at `pixel`. `lens`: the real lens. `rotation`: virtual_from_camera. Precondition: the
// direction points forwards from the virtual camera.
template <class T>
Vector2<T> virtual_principal_point(const PinholeLens<T>& lens, const Matrix3<T>& rotation,
                                   const Vector3<T>& direction, const Vector2<T>& pixel) {
  const Vector3<T> d = rotation * direction;
  return {pixel.x() - lens.fx * d.x() / d.z(), pixel.y() - lens.fy * d.y() / d.z()};
}

// The virtual camera of `pixel`. `lens`: the real lens. `ray`: the pixel's ray in water [frame of
// the real camera, m].
// `rotation`: virtual_from_camera. Without refraction and with the identity as `rotation`, the
// result is the pinhole camera of the lens.
template <class T>
VirtualCamera<T> virtual_camera(const PinholeLens<T>& lens, const Matrix3<T>& rotation,
                                const AxialRay<T>& ray, const Vector2<T>& pixel) {
  const Vector2<T> c = virtual_principal_point(lens, rotation, ray.direction, pixel);
  return {ray.origin, rotation, {lens.fx, lens.fy, c.x(), c.y()}};
}

// The virtual camera of `pixel` of `camera`, which may be of any type with lens() and ray(). The
// pixel is not rounded. If the camera has no function rotation_to_axis(), like PinholeCamera, the
// result is the pinhole camera of lens() at the camera centre.
template <class Camera, class T = typename Camera::Scalar>
VirtualCamera<T> virtual_camera(const Camera& camera, const Vector2<T>& pixel) {
  if constexpr (requires { camera.rotation_to_axis(); }) {
    return virtual_camera(camera.lens(), Matrix3<T>(camera.rotation_to_axis()), camera.ray(pixel),
                          pixel);
  } else {
    return {Vector3<T>::Zero(), Matrix3<T>::Identity(), camera.lens()};
  }
}

// The pose of the virtual source camera relative to the virtual reference camera (eq. 1):
// x_source = rotation * (x_reference - centre), in the frames of the virtual cameras.
template <class T>
struct RelativePose {
  Matrix3<T> rotation;
  Vector3<T> centre;
};

// Computes this pose from the pose of the real cameras, x_source = R (x_reference - C).
template <class T>
RelativePose<T> relative_pose(const VirtualCamera<T>& reference, const VirtualCamera<T>& source,
                              const Matrix3<T>& R, const Vector3<T>& C) {
  return {source.rotation * R * reference.rotation.transpose(),
          reference.rotation * (C + R.transpose() * source.centre - reference.centre)};
}

// The homography [px to px] from the image of the virtual camera `reference` to the image of the
// virtual camera `source` (eq. 2). The plane through X with the normal n induces the homography. X
// [m] and n are in the frame of the real reference camera. n may have any length. R, C:
// x_source = R (x_reference - C), in the frames of the real cameras. A plane through the centre C_v
// of `reference` gives infinities or NaN.
template <class T>
Matrix3<T> virtual_homography(const VirtualCamera<T>& reference, const VirtualCamera<T>& source,
                              const Matrix3<T>& R, const Vector3<T>& C, const Vector3<T>& X,
                              const Vector3<T>& n) {
  const RelativePose<T> pose = relative_pose(reference, source, R, C);
  const Vector3<T> n_v = reference.rotation * n;
  const T plane = n.dot(X - reference.centre);
  const Matrix3<T> euclidean =
      pose.rotation * (Matrix3<T>::Identity() - pose.centre * n_v.transpose() * (T(1) / plane));
  const PinholeLens<T>& from = reference.lens;
  const PinholeLens<T>& to = source.lens;
  Matrix3<T> K, K_inverse;
  K << to.fx, T(0), to.cx, T(0), to.fy, to.cy, T(0), T(0), T(1);
  K_inverse << T(1) / from.fx, T(0), -from.cx / from.fx,  //
      T(0), T(1) / from.fy, -from.cy / from.fy,           //
      T(0), T(0), T(1);
  return K * euclidean * K_inverse;
}

// The pixel to which the homography H maps `pixel`. If this is a point at infinity, the result is
// infinite or NaN.
template <class T>
Vector2<T> apply_homography(const Matrix3<T>& H, const Vector2<T>& pixel) {
  const Vector3<T> image = H * Vector3<T>(pixel.x(), pixel.y(), T(1));
  return {image.x() / image.z(), image.y() / image.z()};
}

}  // namespace axial::refractive
