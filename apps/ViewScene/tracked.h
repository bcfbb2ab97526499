// SPDX-License-Identifier: GPL-3.0-or-later
// The observations of a COLMAP model, with the cameras and poses of a scene.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "base/context.h"
#include "diagnosis/residuals.h"
#include "io/openmvs/scene_with_cameras.h"

namespace axial::apps {

struct TrackedScene {
  // In the frame of the scene. Images with equal lens, port and name of the port share a camera.
  diagnosis::TrackedPhotographs photographs;
  std::vector<std::size_t> numbers;  // of the images of `photographs`: index into Scene::images
};

// Reads the COLMAP model in `folder` (io::find_colmap_model()). Its images are matched to those of
// the scene by their names; images of either that the other does not have are left out. Pixels of a
// model with distorted lenses are converted for images of the scene that were undistorted. Error
// that names `folder` for a malformed model, no common image, several images of one name, another
// image size, and a pose that differs from that in the scene.
TrackedScene read_tracks(const io::SceneWithCameras& scene, const std::filesystem::path& folder,
                         const Context& context);

}  // namespace axial::apps
