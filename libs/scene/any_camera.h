// SPDX-License-Identifier: GPL-3.0-or-later
// A camera of any kind as one type, for lists that mix kinds. Every call dispatches on the kind.
// Code that handles many pixels or points of one camera should visit kind() once instead.
#pragma once

#include <utility>
#include <variant>

#include "scene/camera_model.h"

namespace axial {

// A camera of the kind that it is made from, with the functions ray() and project() of a camera
// (refractive/axial_ray.h).
template <class T>
class AnyCamera {
 public:
  using Scalar = T;

  explicit AnyCamera(CameraVariant<T> camera) : camera_(std::move(camera)) {}

  // The camera, as the type of its kind.
  const CameraVariant<T>& kind() const { return camera_; }

  // Each function below calls the function with this name of the camera in kind(). ray() returns
  // the ray of `pixel` in the scene medium [camera frame, m], and writes its derivatives by the
  // pixel to `jacobian`. project() returns the projection of X [camera frame, m], and writes
  // d(pixel)/dX [px/m] to `jacobian` and the origin of the ray through X [camera frame, m] to
  // `origin` unless they are null.
  // They are compiled once, for float and double.
  refractive::AxialRay<T> ray(const refractive::Vector2<T>& pixel) const;
  refractive::AxialRay<T> ray(const refractive::Vector2<T>& pixel,
                              refractive::AxialRayJacobian<T>& jacobian) const;
  refractive::Projection<T> project(const refractive::Vector3<T>& X,
                                    refractive::Matrix23<T>* jacobian = nullptr,
                                    refractive::Vector3<T>* origin = nullptr) const;

 private:
  CameraVariant<T> camera_;
};

extern template class AnyCamera<float>;
extern template class AnyCamera<double>;

}  // namespace axial
