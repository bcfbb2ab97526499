// SPDX-License-Identifier: GPL-3.0-or-later
// The cameras of one task (a reference view and its source views) as a list of one camera type.
#pragma once

#include <span>
#include <variant>
#include <vector>

#include "axial/scene_options.h"
#include "refractive/line_search.h"
#include "scene/any_camera.h"
#include "scene/camera_model.h"

namespace axial {

template <class T>
using CameraList = std::variant<
    std::vector<refractive::PinholeCamera<T>>, std::vector<refractive::FlatPortCamera<T>>,
    std::vector<refractive::DomePortCamera<T>>, std::vector<refractive::LineSearchCamera<T>>,
    std::vector<refractive::LensPinholeCamera<T>>, std::vector<refractive::LensFlatPortCamera<T>>,
    std::vector<refractive::LensDomePortCamera<T>>, std::vector<AnyCamera<T>>>;

// Makes the cameras of `models`, in the same order. All cameras of the list have one type, the
// simplest type that fits all of them:
// - If there are flat ports as well as domes, the list is of AnyCamera. Each camera keeps its own
//   kind, and the next rules do not apply.
// - Without any port the cameras are pinholes, and no time is spent on refraction. If some
//   cameras have a port, a camera without a port gets a port whose indices are all 1. Its rays and
//   pixels are exactly those of the pinhole.
// - Without any distortion the lenses have none, and no time is spent on distortion. If some
//   lenses are distorted, a lens without distortion gets coefficients that change nothing.
// - If `method` is the line search and there are flat ports, the list is of LineSearchCamera.
//
// A PinholeCamera does not test whether a pixel lies in the image. All other cameras see only
// points whose images lie in the image widened by an eighth of its longer side. A LineSearchCamera
// sees only points whose images lie in the image itself.
//
// Throws an Error if `method` is the line search and there is a dome or a distorted lens.
template <class T>
CameraList<T> make_camera_list(std::span<const CameraModel> models,
                               ProjectionMethod method = ProjectionMethod::exact);

extern template CameraList<float> make_camera_list<float>(std::span<const CameraModel>,
                                                          ProjectionMethod);
extern template CameraList<double> make_camera_list<double>(std::span<const CameraModel>,
                                                            ProjectionMethod);

}  // namespace axial
