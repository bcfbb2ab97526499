// SPDX-License-Identifier: GPL-3.0-or-later
// The cameras that work on one task together (a reference view and its source views), as one type.
#pragma once

#include <span>
#include <variant>
#include <vector>

#include "refractive/line_search.h"
#include "scene/any_camera.h"
#include "scene/camera_model.h"

namespace axial {

// How points are projected behind a port.
enum class ProjectionMethod {
  exact,
  line_search  // the paper's Algorithm 1, for comparison
};

template <class T>
using CameraList = std::variant<
    std::vector<refractive::PinholeCamera<T>>, std::vector<refractive::FlatPortCamera<T>>,
    std::vector<refractive::DomePortCamera<T>>, std::vector<refractive::LineSearchCamera<T>>,
    std::vector<refractive::LensPinholeCamera<T>>, std::vector<refractive::LensFlatPortCamera<T>>,
    std::vector<refractive::LensDomePortCamera<T>>, std::vector<AnyCamera<T>>>;

// All dry: pinholes, which pay nothing for refraction's existence. Otherwise a dry camera among wet
// ones is a port of index 1, which is the pinhole exactly. In the same way straight lenses pay
// nothing for distortion, and one among distorted ones is a distortion of nothing. Where some are
// behind flat ports and others behind domes, each is of its own kind. Same order as `models`.
// Error: the line search with a dome or a distorted lens.
template <class T>
CameraList<T> make_camera_list(std::span<const CameraModel> models,
                               ProjectionMethod method = ProjectionMethod::exact);

extern template CameraList<float> make_camera_list<float>(std::span<const CameraModel>,
                                                          ProjectionMethod);
extern template CameraList<double> make_camera_list<double>(std::span<const CameraModel>,
                                                            ProjectionMethod);

}  // namespace axial
