// SPDX-License-Identifier: GPL-3.0-or-later
// Shrinks the images of a scene.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace axial::apps {

// Reduces each image whose longer side exceeds `max_resolution` [px] to this length. Writes the
// smaller image to `folder`, and sets the path and the camera of the image in `scene`. The path in
// `folder` is the image's path below the deepest common folder of all images. JPEG files with 8
// bits stay JPEG, other files become PNG. All other images and all masks stay where they are. Error
// for an image that cannot be read or that has transparent pixels, and if an output would replace
// an image of the scene. An error leaves no new file in `folder`.
void shrink_images(unsigned max_resolution, const std::filesystem::path& folder, Scene& scene);

}  // namespace axial::apps
