// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the similarity by which the options move the scene.
#pragma once

#include "base/context.h"
#include "io/openmvs/scene_with_cameras.h"
#include "options.h"
#include "scene/moved_scene.h"

namespace axial::apps {

// Returns the map from the frame of the scene to the frame of the moved scene. Logs how the map was
// found. Errors name the file from which the map follows (Options::align, transform or positions).
FrameMove find_move(const Options& options, const io::SceneWithCameras& scene,
                    const Context& context);

// Error if `similarity` changes the scale and a camera of the scene has a flat port or a dome. No
// error if options.scale_ports is set.
void check_scale(const Options& options, const io::SceneWithCameras& scene,
                 const Similarity& similarity);

}  // namespace axial::apps
