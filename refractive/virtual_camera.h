// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's virtual cameras: for one pixel of an axial camera, the pinhole that sits at the
// pixel's C_v on the axis, looks along the axis, has the focal length of the real lens (f_v = f)
// and shows the pixel's ray at the pixel itself (eq. 3, with y in its second component).
//
// Poses: x_virtual = rotation * (x_camera - centre), and for two views x_source = R (x_reference -
// C). Metres and pixels.
#pragma once

#include "refractive/axial_ray.h"
#include "refractive/pinhole_camera.h"

namespace axial::refractive {

template <class T>
struct VirtualCamera {
  Vector3<T> centre;    // C_v in the frame of the real camera
  Matrix3<T> rotation;  // virtual_from_camera
  PinholeLens<T> lens;  // f_v = f, principal point c_v

  // Image of X [frame of the real camera]. Precondition: X in front of the virtual camera.
  Vector2<T> pixel(const Vector3<T>& X) const { return lens.pixel(rotation * (X - centre)); }
};

// The principal point c_v that makes the virtual camera show the water ray `direction` [camera
// frame] at `pixel` (eq. 3 corrected).
template <class T>
Vector2<T> virtual_principal_point(const PinholeLens<T>& lens, const Matrix3<T>& rotation,
                                   const Vector3<T>& direction, const Vector2<T>& pixel) {
  const Vector3<T> d = rotation * direction;
  return {pixel.x() - lens.fx * d.x() / d.z(), pixel.y() - lens.fy * d.y() / d.z()};
}

// From the ray of a pixel. For a ray without refraction (origin at the centre, direction that of
// the lens, rotation identity) this is the lens's own camera.
template <class T>
VirtualCamera<T> virtual_camera(const PinholeLens<T>& lens, const Matrix3<T>& rotation,
                                const AxialRay<T>& ray, const Vector2<T>& pixel) {
  const Vector2<T> c = virtual_principal_point(lens, rotation, ray.direction, pixel);
  return {ray.origin, rotation, {lens.fx, lens.fy, c.x(), c.y()}};
}

// Exactly at the pixel, for any camera. Cameras with an axis say how it is aligned by
// `rotation_to_axis()`; a pinhole has none.
template <class Camera, class T = typename Camera::Scalar>
VirtualCamera<T> virtual_camera(const Camera& camera, const Vector2<T>& pixel) {
  if constexpr (requires { camera.rotation_to_axis(); }) {
    return virtual_camera(camera.lens(), Matrix3<T>(camera.rotation_to_axis()), camera.ray(pixel),
                          pixel);
  } else {
    return {Vector3<T>::Zero(), Matrix3<T>::Identity(), camera.lens()};
  }
}

// Pose of the source's virtual camera in the frame of the reference's (eq. 1).
template <class T>
struct RelativePose {
  Matrix3<T> rotation;
  Vector3<T> centre;
};

template <class T>
RelativePose<T> relative_pose(const VirtualCamera<T>& reference, const VirtualCamera<T>& source,
                              const Matrix3<T>& R, const Vector3<T>& C) {
  return {source.rotation * R * reference.rotation.transpose(),
          reference.rotation * (C + R.transpose() * source.centre - reference.centre)};
}

// Homography from the reference image to the source image (eq. 2) induced by the plane through X
// with normal n, both in the frame of the real reference camera. A plane through the reference's
// C_v gives infinities or NaN.
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

template <class T>
Vector2<T> apply_homography(const Matrix3<T>& H, const Vector2<T>& pixel) {
  const Vector3<T> image = H * Vector3<T>(pixel.x(), pixel.y(), T(1));
  return {image.x() / image.z(), image.y() / image.z()};
}

// Where the reference's virtual camera sees the point that the source image has at distance
// `distance` on `source_ray` [source camera frame]: the reprojection of the consistency check (eq.
// 7, with the source's own C_v and ray in place of K_j^-1). Compare with the reference pixel.
template <class T>
Vector2<T> virtual_reprojection(const VirtualCamera<T>& reference, const AxialRay<T>& source_ray,
                                const T& distance, const Matrix3<T>& R, const Vector3<T>& C) {
  return reference.pixel(R.transpose() * source_ray.at(distance) + C);
}

}  // namespace axial::refractive
