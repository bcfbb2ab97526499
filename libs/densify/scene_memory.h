// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the allowed memory is enough to read a scene and to score its views.
#pragma once

#include "densify/settings.h"
#include "scene/scene.h"

namespace axial::densify {

// Error that names max_memory, its value and the least necessary value if the scene of
// settings.input is too large to be read and its views scored. The estimate uses the scene's
// counts, before the scene is read. Small scenes that need less than the program itself pass here;
// plan_memory then reports the whole need.
void require_memory_to_read(const Settings& settings);

// The same for a scene that was read, including its lists of neighbours before they are made.
void require_memory_to_score(const Scene& scene, const Settings& settings);

}  // namespace axial::densify
