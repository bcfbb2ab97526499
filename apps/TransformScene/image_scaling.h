// SPDX-License-Identifier: GPL-3.0-or-later
// Shrinks the images of a scene.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace axial::apps {

// Writes images whose longest side is longer than `max_resolution` [px] in a smaller size to
// `folder`, with their paths below the folder that all images have in common, and sets the paths
// and cameras of `scene` accordingly. JPEG files with 8 bits stay JPEG, other files become PNG. All
// other images and all masks stay where they are. Error for an image that cannot be read or that
// has transparent pixels, and if an output would replace an image of the scene.
void shrink_images(unsigned max_resolution, const std::filesystem::path& folder, Scene& scene);

}  // namespace axial::apps
