// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/camera_list.h"

#include <algorithm>

namespace axial {

namespace {

template <class Camera>
std::vector<Camera> behind_ports(std::span<const CameraModel> models) {
  using T = typename Camera::Scalar;
  std::vector<Camera> cameras;
  for (const CameraModel& model : models)
    cameras.emplace_back(model.lens.cast<T>(),
                         model.port.value_or(refractive::FlatPort<double>{}).cast<T>(), model.width,
                         model.height);
  return cameras;
}

}  // namespace

template <class T>
CameraList<T> make_camera_list(std::span<const CameraModel> models, ProjectionMethod method) {
  const bool all_dry =
      std::none_of(models.begin(), models.end(), [](const auto& model) { return model.port; });
  if (all_dry) {
    std::vector<refractive::PinholeCamera<T>> cameras;
    for (const CameraModel& model : models) cameras.emplace_back(model.lens.template cast<T>());
    return cameras;
  }
  if (method == ProjectionMethod::line_search)
    return behind_ports<refractive::LineSearchCamera<T>>(models);
  return behind_ports<refractive::FlatPortCamera<T>>(models);
}

template CameraList<float> make_camera_list<float>(std::span<const CameraModel>, ProjectionMethod);
template CameraList<double> make_camera_list<double>(std::span<const CameraModel>,
                                                     ProjectionMethod);

}  // namespace axial
