// SPDX-License-Identifier: GPL-3.0-or-later
// Checks whether the allowed memory is enough to read a scene and to score its views.
#pragma once

#include "densify/settings.h"
#include "scene/scene.h"

namespace axial::densify {

// Estimates, before the scene is read, the memory for reading the scene of settings.input and for
// scoring its views. The estimate uses the counts of images and points in the files. Throws an
// Error if the allowed memory is less. The error names max_memory, its value and the least
// necessary value. A scene whose estimate is below the memory of the program itself always passes,
// because plan_memory() checks the whole need later.
void require_memory_to_read(const Settings& settings);

// The same check for a scene that was read, before its views are scored. The estimate includes
// the lists of neighbours that scoring makes.
void require_memory_to_score(const Scene& scene, const Settings& settings);

}  // namespace axial::densify
