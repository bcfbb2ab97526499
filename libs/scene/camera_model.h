// SPDX-License-Identifier: GPL-3.0-or-later
// The camera of one image as data, and the switch from data to a camera type: the only place above
// refractive/ that knows which kinds of camera there are.
#pragma once

#include <optional>
#include <variant>

#include "refractive/dome_port_camera.h"
#include "refractive/flat_port_camera.h"
#include "refractive/pinhole_camera.h"
#include "refractive/port.h"

namespace axial {

// The in-air lens and the port, if any. Pixel centres at integers; lens in pixels of width x
// height.
struct CameraModel {
  int width = 0;
  int height = 0;
  refractive::PinholeLens<double> lens{0, 0, 0, 0};
  std::optional<refractive::Port<double>> port;  // none: dry

  // The same camera for the image resized to new_width x new_height (independent factors per axis;
  // the corner of the image, at (-0.5, -0.5), stays fixed).
  CameraModel resized(int new_width, int new_height) const;
};

template <class T>
using CameraVariant = std::variant<refractive::PinholeCamera<T>, refractive::FlatPortCamera<T>,
                                   refractive::DomePortCamera<T>>;

// T is float (matching) or double (geometry). Visit once per image or image pair, never per pixel.
template <class T>
CameraVariant<T> make_camera(const CameraModel& model);

extern template CameraVariant<float> make_camera<float>(const CameraModel&);
extern template CameraVariant<double> make_camera<double>(const CameraModel&);

}  // namespace axial
