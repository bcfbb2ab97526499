// SPDX-License-Identifier: GPL-3.0-or-later
// What the photographs say about the water, the light and the camera.
#pragma once

#include <Eigen/Core>

#include "color/observations.h"
#include "options.h"
#include "report.h"
#include "survey/survey.h"

namespace axial::apps {

// The upward direction in the frame of the scene, unit; zero: not known.
Eigen::Vector3d up_of(const Settings& settings, const survey::Survey& survey);

// Finds the water, the light, the exposures and the curve of the camera. Findings::gain is that of
// a grey seabed. Error for photographs that have too few points in common or determine no channel,
// and for a file of exposures that lacks a photograph.
Findings find(const Settings& settings, const survey::Survey& survey,
              const color::SeenSurface& surface, const Context& context);

}  // namespace axial::apps
