// SPDX-License-Identifier: BSD-3-Clause
// The warp of a plane between two axial cameras maps the pixel of a point of the plane in the
// reference image to the pixel of the same point in the source image. This file computes the exact
// value and the exact first derivative of the warp at a pixel p (docs/refraction.md, "The warp").
// The formula is the same for all cameras.
//
//     warp(q) = project_j(X_j(p)) + A (q - p),    A = Jproj_j(X_j) * R_ij * dX/dp
//
// Frames: the point X, the plane and the ray are in the frame of the reference camera i.
// X_j = R_ij (X - C_ij) is in the frame of the source camera j. C_ij is the centre of camera j in
// the frame of camera i. Units: metres and pixels. No function checks its arguments. NaN arguments
// give NaN results. docs/refraction.md names the paper whose equation numbers are used here.
#pragma once

#include "refractive/axial_ray.h"

namespace axial::refractive {

// The distance [m] along `ray` at which the ray meets the plane through X with the normal n (the
// paper's eq. 8). The distance is negative if the plane lies behind the ray's origin. n may have
// any length and either sign. A ray parallel to the plane gives infinity or NaN.
template <class T>
T plane_intersection(const AxialRay<T>& ray, const Vector3<T>& X, const Vector3<T>& n) {
  return (X - ray.origin).dot(n) / ray.direction.dot(n);
}

// The derivative dX/dp [m/px]. Let X = ray.at(lambda) be the point at which the ray of the pixel p
// meets the plane with the normal n. When p changes, X moves on the plane:
//
//     dX/dp = (I - d n^T / (n.d)) (do/dp + lambda dd/dp)
//
// where o and d are the origin and the direction of the ray. `jacobian`: do/dp and dd/dp. n may
// have any length and either sign. n.d = 0 gives infinities or NaN.
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

// The warp from the reference image to the source image around the pixel p. X is the point of the
// plane that the pixel p shows.
template <class T>
struct AffineWarp {
  Vector2<T> from;    // p in the reference image
  Vector2<T> to;      // warp(p), the exact image of X in the source image
  Matrix2<T> linear;  // A
  Mask<T> visible;    // false: the source camera does not see X, the warp is meaningless

  // The pixel of the source image for the pixel q of the reference image, exact to first order in
  // q - p.
  Vector2<T> operator()(const Vector2<T>& q) const { return to + linear * (q - from); }
};

// Computes the warp from `reference` to `source`, two axial cameras (axial_ray.h), around the pixel
// p of `reference`. Let X be the point at the distance `lambda` [m] on the ray of p. The plane
// passes through X and has the normal n [frame of `reference`], of any length. `rotation` and
// `centre` are R_ij and C_ij: X_j = rotation * (X - centre).
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
