// SPDX-License-Identifier: GPL-3.0-or-later
// The camera that Python sees: its numbers, and the axial camera that is made of them once.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "axial/scene.h"
#include "scene/camera_model.h"

namespace axial::python {

struct Lens {
  refractive::PinholeLens<double> pinhole;
  std::optional<refractive::LensDistortion<double>> distortion;  // empty: none
};

struct Camera {
  CameraModel model;
  CameraVariant<double> camera;

  // Throws an Error that begins with `where` for values that are not possible
  // (survey::check_camera()), and for a distortion that mirrors the image.
  Camera(const CameraModel& of, const std::string& where);
};

// "FlatPort(distance=0.02, ...)", for texts in the manner of Python.
std::string text_of(const refractive::Port<double>& port);
std::string text_of(const Lens& lens);

}  // namespace axial::python
