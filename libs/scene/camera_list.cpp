// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/camera_list.h"

#include <algorithm>

#include "base/error.h"

namespace axial {

namespace {

// `none`: the port for cameras without a port.
template <class Camera, class Port>
std::vector<Camera> behind_ports(std::span<const CameraModel> models, const Port& none) {
  using T = typename Camera::Scalar;
  std::vector<Camera> cameras;
  for (const CameraModel& model : models) {
    const Port& port = model.port ? std::get<Port>(*model.port) : none;
    if constexpr (requires(const Camera& camera) { camera.distorted_lens(); })
      cameras.emplace_back(distorted_lens<T>(model), port.template cast<T>());
    else
      cameras.emplace_back(model.lens.cast<T>(), port.template cast<T>(), model.width,
                           model.height);
  }
  return cameras;
}

template <class T>
std::vector<refractive::LensPinholeCamera<T>> with_distortion(std::span<const CameraModel> models) {
  std::vector<refractive::LensPinholeCamera<T>> cameras;
  for (const CameraModel& model : models) cameras.emplace_back(distorted_lens<T>(model));
  return cameras;
}

template <class T>
std::vector<AnyCamera<T>> each_of_its_kind(std::span<const CameraModel> models) {
  std::vector<AnyCamera<T>> cameras;
  for (const CameraModel& model : models) cameras.emplace_back(make_camera<T>(model));
  return cameras;
}

template <class Port>
bool any_behind(std::span<const CameraModel> models) {
  return std::ranges::any_of(models, [](const CameraModel& model) {
    return model.port && std::holds_alternative<Port>(*model.port);
  });
}

}  // namespace

template <class T>
CameraList<T> make_camera_list(std::span<const CameraModel> models, ProjectionMethod method) {
  const bool flat = any_behind<refractive::FlatPort<double>>(models);
  const bool dome = any_behind<refractive::DomePort<double>>(models);
  const bool distorted = std::ranges::any_of(
      models, [](const CameraModel& model) { return model.distortion.has_value(); });
  if (distorted && method == ProjectionMethod::line_search)
    fail(
        "the projection line-search is only for lenses without distortion: undistort the images "
        "first, with InterfaceCOLMAP");
  if (!flat && !dome) {
    if (distorted) return with_distortion<T>(models);
    std::vector<refractive::PinholeCamera<T>> cameras;
    for (const CameraModel& model : models) cameras.emplace_back(model.lens.template cast<T>());
    return cameras;
  }
  if (dome && method == ProjectionMethod::line_search)
    fail("the projection line-search is only for flat ports: use the projection exact for domes");
  if (flat && dome) return each_of_its_kind<T>(models);
  const refractive::FlatPort<double> no_port;
  // A dome without effect. Points inside a dome are not visible, so that its radius must be smaller
  // than the distance of any point.
  const refractive::DomePort<double> no_dome{{0, 0, 0}, 1e-4};
  if (dome && distorted) return behind_ports<refractive::LensDomePortCamera<T>>(models, no_dome);
  if (dome) return behind_ports<refractive::DomePortCamera<T>>(models, no_dome);
  if (distorted) return behind_ports<refractive::LensFlatPortCamera<T>>(models, no_port);
  if (method == ProjectionMethod::line_search)
    return behind_ports<refractive::LineSearchCamera<T>>(models, no_port);
  return behind_ports<refractive::FlatPortCamera<T>>(models, no_port);
}

template CameraList<float> make_camera_list<float>(std::span<const CameraModel>, ProjectionMethod);
template CameraList<double> make_camera_list<double>(std::span<const CameraModel>,
                                                     ProjectionMethod);

}  // namespace axial
