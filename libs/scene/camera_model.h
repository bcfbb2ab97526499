// SPDX-License-Identifier: GPL-3.0-or-later
// The construction of a camera object from the data of a camera. Only this header and camera_list.h
// list the kinds of cameras.
#pragma once

#include <optional>
#include <variant>

#include "axial/scene.h"
#include "refractive/dome_port_camera.h"
#include "refractive/flat_port_camera.h"
#include "refractive/lens_camera.h"
#include "refractive/pinhole_camera.h"
#include "refractive/port.h"

namespace axial {

// The lens of `model`, with or without distortion, as the constructor of refractive::LensCamera
// takes it. The image is widened by the default margin, an eighth of its longer side.
template <class T>
refractive::DistortedLens<T> distorted_lens(const CameraModel& model);

template <class T>
using CameraVariant =
    std::variant<refractive::PinholeCamera<T>, refractive::FlatPortCamera<T>,
                 refractive::DomePortCamera<T>, refractive::LensPinholeCamera<T>,
                 refractive::LensFlatPortCamera<T>, refractive::LensDomePortCamera<T>>;

// Makes the camera of `model`, of the kind that `port` and `distortion` of `model` require. T is
// float (matching) or double (geometry). The values of `model` are not checked. Visit the variant
// once per image or image pair, not per pixel, because the dispatch costs time.
template <class T>
CameraVariant<T> make_camera(const CameraModel& model);

// A camera whose lens maps the direction in air (u, v, 1) [camera frame] to the pixel (u, v). A
// lens of any kind can then map (u, v) to its own pixel (lens_camera.h). |u| and |v| can be up to
// 1e6, and the incidence on a flat port up to 88.8 degrees.
using TangentCamera =
    std::variant<refractive::PinholeCamera<double>, refractive::FlatPortCamera<double>,
                 refractive::DomePortCamera<double>>;

// Makes the camera behind `port`, or in air if `port` is empty. `usual` (above 0) affects only the
// speed: points are projected fastest if the tangent of the angle between their direction in air
// and the optical axis is at most `usual`.
TangentCamera make_tangent_camera(const std::optional<refractive::Port<double>>& port,
                                  double usual);

extern template refractive::DistortedLens<float> distorted_lens<float>(const CameraModel&);
extern template refractive::DistortedLens<double> distorted_lens<double>(const CameraModel&);
extern template CameraVariant<float> make_camera<float>(const CameraModel&);
extern template CameraVariant<double> make_camera<double>(const CameraModel&);

}  // namespace axial
