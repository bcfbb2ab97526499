// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/camera_model.h"

#include <algorithm>
#include <cmath>

namespace axial {

CameraModel CameraModel::resized(int new_width, int new_height) const {
  const double sx = static_cast<double>(new_width) / width;
  const double sy = static_cast<double>(new_height) / height;
  CameraModel model = *this;
  model.width = new_width;
  model.height = new_height;
  model.lens = {lens.fx * sx, lens.fy * sy, (lens.cx + 0.5) * sx - 0.5, (lens.cy + 0.5) * sy - 0.5};
  return model;
}

template <class T>
refractive::DistortedLens<T> distorted_lens(const CameraModel& model) {
  return {model.lens, model.distortion.value_or(refractive::LensDistortion<double>{}), model.width,
          model.height};
}

namespace {

struct TangentsBehindPort {
  double usual;

  TangentCamera operator()(const refractive::FlatPort<double>& port) const {
    constexpr double kGrazing = 50;  // 88.8 degrees
    const double tilt = std::acos(std::clamp(port.normal.z(), -1.0, 1.0));
    const double angle = std::min(std::atan(usual) + tilt, std::atan(kGrazing));
    const refractive::FlatPortField<double> field(refractive::FlatPortOptics<double>(port),
                                                  kGrazing, std::max(1e-3, std::tan(angle)));
    return refractive::FlatPortCamera<double>(refractive::tangent_lens<double>(), port, field,
                                              refractive::all_tangents<double>());
  }
  TangentCamera operator()(const refractive::DomePort<double>& port) const {
    return refractive::DomePortCamera<double>(refractive::tangent_lens<double>(), port,
                                              refractive::all_tangents<double>());
  }
};

// Makes the camera of `model` behind a port of either kind.
template <class T>
struct BehindPort {
  const CameraModel& model;

  template <template <class> class Straight, template <class> class Distorted, class Port>
  CameraVariant<T> behind(const Port& port) const {
    if (model.distortion) return Distorted<T>(distorted_lens<T>(model), port.template cast<T>());
    return Straight<T>(model.lens.cast<T>(), port.template cast<T>(), model.width, model.height);
  }
  CameraVariant<T> operator()(const refractive::FlatPort<double>& port) const {
    return behind<refractive::FlatPortCamera, refractive::LensFlatPortCamera>(port);
  }
  CameraVariant<T> operator()(const refractive::DomePort<double>& port) const {
    return behind<refractive::DomePortCamera, refractive::LensDomePortCamera>(port);
  }
};

}  // namespace

template <class T>
CameraVariant<T> make_camera(const CameraModel& model) {
  if (model.port) return std::visit(BehindPort<T>{model}, *model.port);
  if (model.distortion) return refractive::LensPinholeCamera<T>(distorted_lens<T>(model));
  return refractive::PinholeCamera<T>(model.lens.cast<T>());
}

TangentCamera make_tangent_camera(const std::optional<refractive::Port<double>>& port,
                                  double usual) {
  if (port) return std::visit(TangentsBehindPort{usual}, *port);
  return refractive::PinholeCamera<double>(refractive::tangent_lens<double>());
}

template refractive::DistortedLens<float> distorted_lens<float>(const CameraModel&);
template refractive::DistortedLens<double> distorted_lens<double>(const CameraModel&);
template CameraVariant<float> make_camera<float>(const CameraModel&);
template CameraVariant<double> make_camera<double>(const CameraModel&);

}  // namespace axial
