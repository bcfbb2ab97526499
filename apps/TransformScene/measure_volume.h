// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "options.h"
#include "scene/moved_scene.h"
#include "scene/scene.h"

namespace axial::apps {

// Logs the volume of the mesh of the options after `move`. `scene`: after it, in move.to. Error
// that names the mesh if its volume is not determined.
void measure_volume(const Options& options, const Scene& scene, const FrameMove& move);

}  // namespace axial::apps
