// SPDX-License-Identifier: GPL-3.0-or-later
// A survey in memory (axial/survey.h) in the form of a survey of files.
#pragma once

#include <optional>
#include <string>

#include "io/openmvs/scene_with_cameras.h"
#include "survey/survey.h"

namespace axial::survey {

// Error that names `field`, the value and its name, as in "images[3].camera.width 0: ...", if a
// size or a focal length is not above 0, a number is not finite, or the port is not possible
// (io::check_port). The distortion is not checked.
void check_camera(const CameraModel& camera, const std::string& field);

// Returns the housing of the ports of the calibrated cameras, which are named "port_1", "port_2"
// and so on; nothing if no camera has a port. Sets SceneImage::port_name in `scene`.
std::optional<io::Housing> housing_of(Scene& scene);

// Returns the scene in its local frame, with its housing_of(). Error as for check().
io::SceneWithCameras scene_of(const MemorySurvey& survey);

// The header of the photograph of an image.
io::ImageHeader header_of(const MemorySurvey& survey, std::size_t image);

// Reads the photograph of an image. Error that names the image if the photograph is not as
// MemorySurvey demands.
io::Photograph photograph_of(const MemorySurvey& survey, std::size_t image);

}  // namespace axial::survey
