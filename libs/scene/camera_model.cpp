// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/camera_model.h"

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

namespace {

// The camera behind a port of either kind.
template <class T>
struct BehindPort {
  const CameraModel& model;

  CameraVariant<T> operator()(const refractive::FlatPort<double>& port) const {
    return refractive::FlatPortCamera<T>(model.lens.cast<T>(), port.cast<T>(), model.width,
                                         model.height);
  }
  CameraVariant<T> operator()(const refractive::DomePort<double>& port) const {
    return refractive::DomePortCamera<T>(model.lens.cast<T>(), port.cast<T>(), model.width,
                                         model.height);
  }
};

}  // namespace

template <class T>
CameraVariant<T> make_camera(const CameraModel& model) {
  if (!model.port) return refractive::PinholeCamera<T>(model.lens.cast<T>());
  return std::visit(BehindPort<T>{model}, *model.port);
}

template CameraVariant<float> make_camera<float>(const CameraModel&);
template CameraVariant<double> make_camera<double>(const CameraModel&);

}  // namespace axial
