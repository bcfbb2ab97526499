// SPDX-License-Identifier: GPL-3.0-or-later
// The camera of one image as data, and the switch from data to a camera type: the only place above
// refractive/ that knows which kinds of camera there are.
#pragma once

#include <optional>
#include <variant>

#include "refractive/dome_port_camera.h"
#include "refractive/flat_port_camera.h"
#include "refractive/lens_camera.h"
#include "refractive/pinhole_camera.h"
#include "refractive/port.h"

namespace axial {

// The in-air lens, the port and the lens's distortion, if any. Pixel centres at integers; lens in
// pixels of width x height.
struct CameraModel {
  int width = 0;
  int height = 0;
  refractive::PinholeLens<double> lens{0, 0, 0, 0};
  std::optional<refractive::Port<double>> port;                       // none: dry
  std::optional<refractive::LensDistortion<double>> distortion = {};  // none: straight

  // The same camera for the image resized to new_width x new_height (independent factors per axis;
  // the corner of the image, at (-0.5, -0.5), stays fixed).
  CameraModel resized(int new_width, int new_height) const;
};

// The lens of `model`, straight or not, as LensCamera takes it.
template <class T>
refractive::DistortedLens<T> distorted_lens(const CameraModel& model);

template <class T>
using CameraVariant =
    std::variant<refractive::PinholeCamera<T>, refractive::FlatPortCamera<T>,
                 refractive::DomePortCamera<T>, refractive::LensPinholeCamera<T>,
                 refractive::LensFlatPortCamera<T>, refractive::LensDomePortCamera<T>>;

// T is float (matching) or double (geometry). Visit once per image or image pair, never per pixel.
template <class T>
CameraVariant<T> make_camera(const CameraModel& model);

extern template refractive::DistortedLens<float> distorted_lens<float>(const CameraModel&);
extern template refractive::DistortedLens<double> distorted_lens<double>(const CameraModel&);
extern template CameraVariant<float> make_camera<float>(const CameraModel&);
extern template CameraVariant<double> make_camera<double>(const CameraModel&);

}  // namespace axial
