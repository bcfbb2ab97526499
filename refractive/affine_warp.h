// SPDX-License-Identifier: GPL-3.0-or-later
// The warp between two axial cameras induced by a plane: its exact centre and its exact first
// derivative (DESIGN: "The paper's method, and the better warp"). One formula for all cameras.
//
//     warp(q) = project_j(X_j(p)) + A (q - p),    A = Jproj_j(X_j) * R_ij * dX/dp
//
// Frames: X, the plane and the ray in the reference camera i; X_j = R_ij (X - C_ij) in the source
// camera j. Metres and pixels. All functions are plain arithmetic: NaN in, NaN out.
#pragma once

#include "refractive/axial_ray.h"

namespace axial::refractive {

// Distance along `ray` at which it meets the plane through X with normal n (the paper's eq. 8). n
// need not be of unit length. A ray in the plane gives infinity or NaN.
template <class T>
T plane_intersection(const AxialRay<T>& ray, const Vector3<T>& X, const Vector3<T>& n) {
  return (X - ray.origin).dot(n) / ray.direction.dot(n);
}

// dX/dp [m/pixel]: how the point of the plane with normal n that the pixel sees moves with the
// pixel, at X = ray.at(lambda):
//
//     dX/dp = (I - d n^T / (n.d)) (do/dp + lambda dd/dp)
//
// n need not be of unit length and its sign does not matter; n.d = 0 gives infinities or NaN.
template <class T>
Matrix32<T> plane_point_derivative(const AxialRay<T>& ray, const AxialRayJacobian<T>& jacobian,
                                   const T& lambda, const Vector3<T>& n) {
  const Matrix32<T> free = jacobian.origin + lambda * jacobian.direction;
  const Vector3<T> slide = ray.direction * (T(1) / ray.direction.dot(n));
  Matrix32<T> dX;
  dX.col(0) = free.col(0) - slide * n.dot(free.col(0));
  dX.col(1) = free.col(1) - slide * n.dot(free.col(1));
  return dX;
}

// A: pixels of the source image per pixel of the reference image. `projection_jacobian` is
// d(pixel)/dX of the source camera at X_j, `rotation` is R_ij, `dX` from above.
template <class T>
Matrix2<T> warp_derivative(const Matrix23<T>& projection_jacobian, const Matrix3<T>& rotation,
                           const Matrix32<T>& dX) {
  const Matrix32<T> rotated = rotation * dX;
  return projection_jacobian * rotated;
}

// The warp as the matcher uses it.
template <class T>
struct AffineWarp {
  Vector2<T> from;    // p in the reference image
  Vector2<T> to;      // its exact image in the source image
  Matrix2<T> linear;  // A
  Mask<T> visible;    // false: the source camera does not see the plane's point; do not use

  Vector2<T> operator()(const Vector2<T>& q) const { return to + linear * (q - from); }
};

// All of the above at once, for the pixel p of the camera `reference`, whose plane passes through
// the point at distance `lambda` on its ray with normal n. `rotation`, `centre`: R_ij and C_ij.
template <class Reference, class Source, class T = typename Reference::Scalar>
AffineWarp<T> affine_warp(const Reference& reference, const Source& source,
                          const Matrix3<T>& rotation, const Vector3<T>& centre, const Vector2<T>& p,
                          const T& lambda, const Vector3<T>& n) {
  AxialRayJacobian<T> ray_jacobian;
  const AxialRay<T> ray = reference.ray(p, ray_jacobian);
  const Vector3<T> X = rotation * (ray.at(lambda) - centre);
  Matrix23<T> projection_jacobian;
  const Projection<T> image = source.project(X, &projection_jacobian);
  const Matrix32<T> dX = plane_point_derivative(ray, ray_jacobian, lambda, n);
  return {p, image.pixel, warp_derivative(projection_jacobian, rotation, dX), image.visible};
}

}  // namespace axial::refractive
