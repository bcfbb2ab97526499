// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/context.h"
#include "options.h"
#include "scene/moved_scene.h"
#include "scene/scene.h"

namespace axial::apps {

// Logs the volume that options.mesh has after `move`. `scene`: the moved scene, in the frame
// move.to. Error that names the mesh if the volume is not defined, for example because the mesh is
// not closed and no ground plane is used.
void measure_volume(const Options& options, const Scene& scene, const FrameMove& move,
                    const Context& context);

}  // namespace axial::apps
