// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/any_camera.h"

namespace axial {

template <class T>
refractive::AxialRay<T> AnyCamera<T>::ray(const refractive::Vector2<T>& pixel) const {
  return std::visit([&](const auto& camera) { return camera.ray(pixel); }, camera_);
}

template <class T>
refractive::AxialRay<T> AnyCamera<T>::ray(const refractive::Vector2<T>& pixel,
                                          refractive::AxialRayJacobian<T>& jacobian) const {
  return std::visit([&](const auto& camera) { return camera.ray(pixel, jacobian); }, camera_);
}

template <class T>
refractive::Projection<T> AnyCamera<T>::project(const refractive::Vector3<T>& X,
                                                refractive::Matrix23<T>* jacobian,
                                                refractive::Vector3<T>* origin) const {
  return std::visit([&](const auto& camera) { return camera.project(X, jacobian, origin); },
                    camera_);
}

template class AnyCamera<float>;
template class AnyCamera<double>;

}  // namespace axial
