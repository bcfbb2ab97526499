// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's virtual camera (refractive/virtual_camera.h), but with the locally correct scale
// instead of the focal length f_v = f. The scale is a 2x2 matrix, because the horizontal and the
// vertical scale differ behind a flat port.
#pragma once

#include <Eigen/LU>

#include "refractive/virtual_camera.h"

namespace axial::experiments {

// Its pose: x_virtual = rotation * (x_camera - centre). Its projection: pixel_from_ray * x_virtual,
// in homogeneous coordinates.
template <class T>
struct ScaledVirtualCamera {
  refractive::Vector3<T> centre;          // C_v in the frame of the real camera [m]
  refractive::Matrix3<T> rotation;        // virtual_from_camera
  refractive::Matrix3<T> pixel_from_ray;  // K: scale and principal point [px]
};

// Returns the virtual camera of `pixel` [px], which is not rounded. `camera`: any camera with
// rotation_to_axis() and a ray() with a Jacobian, such as FlatPortCamera. Let (x, y, z) be the
// direction of the pixel's ray in water in the frame of the virtual camera, and s = (x/z, y/z). The
// scale is the 2x2 matrix d(pixel)/ds, the inverse of ds/d(pixel). The principal point is
// c_v = pixel - scale * s, as in the paper's eq. 3. K has the scale as its upper left 2x2 block and
// the principal point in its last column.
template <class Camera, class T = typename Camera::Scalar>
ScaledVirtualCamera<T> scaled_virtual_camera(const Camera& camera,
                                             const refractive::Vector2<T>& pixel) {
  refractive::AxialRayJacobian<T> jacobian;
  const refractive::AxialRay<T> ray = camera.ray(pixel, jacobian);
  const refractive::Matrix3<T> rotation = camera.rotation_to_axis();
  const refractive::Vector3<T> d = rotation * ray.direction;
  const refractive::Matrix32<T> dd = rotation * jacobian.direction;
  const refractive::Vector2<T> y = d.template head<2>() / d.z();
  const refractive::Matrix2<T> dy = (dd.template topRows<2>() - y * dd.row(2)) / d.z();
  const refractive::Matrix2<T> scale = dy.inverse();
  refractive::Matrix3<T> K = refractive::Matrix3<T>::Identity();
  K.template topLeftCorner<2, 2>() = scale;
  K.template topRightCorner<2, 1>() = pixel - scale * y;
  return {ray.origin, rotation, K};
}

// Returns the homography [px to px] of the paper's eq. 2, from the image of the virtual camera
// `reference` to the image of the virtual camera `source`. R, C: x_source = R (x_reference - C), in
// the frames of the real cameras. The plane through X [m] with the normal n induces the homography.
// X and n are in the frame of the real reference camera. n may have any length. A plane through the
// centre C_v of `reference` gives infinities or NaN.
template <class T>
refractive::Matrix3<T> scaled_homography(const ScaledVirtualCamera<T>& reference,
                                         const ScaledVirtualCamera<T>& source,
                                         const refractive::Matrix3<T>& R,
                                         const refractive::Vector3<T>& C,
                                         const refractive::Vector3<T>& X,
                                         const refractive::Vector3<T>& n) {
  using Matrix3 = refractive::Matrix3<T>;
  const Matrix3 rotation = source.rotation * R * reference.rotation.transpose();
  const refractive::Vector3<T> centre =
      reference.rotation * (C + R.transpose() * source.centre - reference.centre);
  const refractive::Vector3<T> n_v = reference.rotation * n;
  const T plane = n.dot(X - reference.centre);
  const Matrix3 euclidean =
      rotation * (Matrix3::Identity() - centre * n_v.transpose() * (T(1) / plane));
  return source.pixel_from_ray * euclidean * reference.pixel_from_ray.inverse();
}

}  // namespace axial::experiments
