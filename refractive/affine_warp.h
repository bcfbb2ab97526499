// SPDX-License-Identifier: GPL-3.0-or-later
// The warp between two axial cameras that a plane induces: its exact value and its exact first
// derivative at one pixel (docs/refraction.md, "The warp"). The formula is the same for all
// cameras.
//
//     warp(q) = project_j(X_j(p)) + A (q - p),    A = Jproj_j(X_j) * R_ij * dX/dp
//
// Frames: X, the plane and the ray in the reference camera i; X_j = R_ij (X - C_ij) in the source
// camera j. Metres and pixels. No function checks its arguments; NaN arguments give NaN results.
#pragma once

#include "refractive/axial_ray.h"

namespace axial::refractive {

// Distance along `ray` at which it meets the plane through X with normal n (the paper's eq. 8). n
// may have any length. A ray parallel to the plane gives infinity or NaN.
template <class T>
T plane_intersection(const AxialRay<T>& ray, const Vector3<T>& X, const Vector3<T>& n) {
  return (X - ray.origin).dot(n) / ray.direction.dot(n);
}

// dX/dp [m/px]: the derivative by the pixel p of the point X in which the pixel's ray meets the
// plane with normal n, at X = ray.at(lambda):
//
//     dX/dp = (I - d n^T / (n.d)) (do/dp + lambda dd/dp)
//
// with o and d the ray's origin and direction. n may have any length and either sign; n.d = 0
// gives infinities or NaN. `jacobian`: the derivatives of `ray` by the pixel.
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

// The matrix A [pixels of the source image per pixel of the reference image].
// `projection_jacobian`: d(pixel)/dX of the source camera at X_j. `rotation`: R_ij. `dX`: the
// result of plane_point_derivative().
template <class T>
Matrix2<T> warp_derivative(const Matrix23<T>& projection_jacobian, const Matrix3<T>& rotation,
                           const Matrix32<T>& dX) {
  const Matrix32<T> rotated = rotation * dX;
  return projection_jacobian * rotated;
}

// The warp from the reference image to the source image around the pixel p.
template <class T>
struct AffineWarp {
  Vector2<T> from;    // p in the reference image
  Vector2<T> to;      // exact image of the plane's point in the source image
  Matrix2<T> linear;  // A
  Mask<T> visible;    // false: the source camera does not see the point, the warp is meaningless

  Vector2<T> operator()(const Vector2<T>& q) const { return to + linear * (q - from); }
};

// Computes the warp from `reference` to `source` for the pixel p of `reference`. The plane passes
// through the point at distance `lambda` [m] on the ray of p and has the normal n [frame of
// `reference`]. `rotation` and `centre`: R_ij and C_ij.
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
