// SPDX-License-Identifier: GPL-3.0-or-later
// The similarity that the options demand.
#pragma once

#include "io/openmvs/scene_with_cameras.h"
#include "options.h"
#include "scene/moved_scene.h"

namespace axial::apps {

// Returns the map from the scene's frame to the frame that the moved scene will have. Logs how it
// was found. Errors name the file.
FrameMove find_move(const Options& options, const io::SceneWithCameras& scene);

// Error if the map changes the scale of a scene whose cameras carry ports, unless
// options.scale_ports.
void check_scale(const Options& options, const io::SceneWithCameras& scene,
                 const Similarity& similarity);

}  // namespace axial::apps
