// SPDX-License-Identifier: GPL-3.0-or-later
// A survey in memory (axial/survey.h) in the form of a survey of files.
#pragma once

#include "io/openmvs/scene_with_cameras.h"
#include "survey/survey.h"

namespace axial::survey {

// Returns the scene in its local frame. Its housing has the ports of the cameras, named "port_1",
// "port_2" and so on. Error as for check().
io::SceneWithCameras scene_of(const MemorySurvey& survey);

// The header of the photograph of an image.
io::ImageHeader header_of(const MemorySurvey& survey, std::size_t image);

// Reads the photograph of an image. Error that names the image if the photograph is not as
// MemorySurvey demands.
io::Photograph photograph_of(const MemorySurvey& survey, std::size_t image);

}  // namespace axial::survey
