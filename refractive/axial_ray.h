// SPDX-License-Identifier: BSD-3-Clause
// The axial camera, the camera model of the whole project. The scene medium is the medium that
// contains the imaged points: water for a camera behind a port, air for a camera without a port.
// The lines of all pixels' rays in the scene medium meet one axis through the camera centre. A
// camera is any type with
//
//     AxialRay<T>   ray(pixel)                      back-projection: the pixel's ray in the scene
//                                                   medium, in the camera frame
//     AxialRay<T>   ray(pixel, AxialRayJacobian&)   back-projection that also writes the
//                                                   derivatives of the ray by the pixel
//     Projection<T> project(X)                      exact forward projection
//     Projection<T> project(X, Matrix23<T>*)        forward projection that also writes d(pixel)/dX
//                                                   [px/m]; a null pointer is allowed
//     Vector3<T>    exit_point(pixel)               where the back-projected ray enters the scene
//                                                   medium [camera frame, m]
//
// The SIMD code also needs
//
//     void               each_field(visit)          calls visit(number) for every number of the
//                                                   camera in a fixed order
//     Projector          projector()                the part of the camera that projects points; a
//                                                   projector has each_field(visit), too
//     RigidTransform<T>  projector_frame()          from the camera frame to the projector's frame
//     Image              projector().image(X)       for a point X in the projector's frame: the
//                                                   projection of X, the derivative of the pixel
//                                                   by X, and the origin of the ray through X
//
// Frames: x right, y down, z forward, origin at the camera centre, metres. Pixel centres lie at
// integers.
#pragma once

#include <Eigen/Core>

#include "refractive/scalar.h"

namespace axial::refractive {

template <class T>
using Vector2 = Eigen::Matrix<T, 2, 1>;
template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Matrix2 = Eigen::Matrix<T, 2, 2>;
template <class T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;
template <class T>
using Matrix23 = Eigen::Matrix<T, 2, 3>;
template <class T>
using Matrix32 = Eigen::Matrix<T, 3, 2>;

// A ray in the scene medium: X = origin + lambda * direction (the paper's eq. 4). The origin lies
// on the camera's axis; for a pinhole it is the camera centre. The direction has unit length.
template <class T>
struct AxialRay {
  Vector3<T> origin;
  Vector3<T> direction;

  // The point X at the distance `lambda` [m] from the origin. A negative `lambda` gives a point
  // behind the origin.
  Vector3<T> at(const T& lambda) const { return origin + lambda * direction; }
};

// Derivatives of the ray by the pixel (u, v): column 0 by u, column 1 by v. `origin` is in m/px,
// `direction` in 1/px.
template <class T>
struct AxialRayJacobian {
  Matrix32<T> origin;
  Matrix32<T> direction;
};

// Maps a point x [m] to rotation * x + translation.
template <class T>
struct RigidTransform {
  Matrix3<T> rotation;
  Vector3<T> translation;
};

// The image of a point. `visible` is true if light from the point reaches the lens within the
// camera's field. Each camera type defines its field, which may be larger than the image
// rectangle. So the pixel of a visible point may lie outside the image rectangle. If `visible` is
// false, `pixel` is finite but meaningless.
template <class T>
struct Projection {
  Vector2<T> pixel;
  Mask<T> visible;
};

}  // namespace axial::refractive
