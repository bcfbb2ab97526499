// SPDX-License-Identifier: GPL-3.0-or-later
// From a scene back to a COLMAP model.
#pragma once

#include <filesystem>

#include "io/colmap.h"
#include "scene/scene.h"

namespace axial::io {

// The calibrated images of `scene`, one PINHOLE camera (with its port, if any) for each distinct
// one, and the sparse points. Image ids are the scene's plus one, names relative to `image_folder`.
// Observations are where the points project to: a scene does not keep those that were measured.
// Views that a camera cannot have are left out, and so are points without any. Error that names the
// image for a distorted lens, a path outside `image_folder` and two images with one name.
ColmapModel export_colmap_model(const Scene& scene, const std::filesystem::path& image_folder);

// The deepest folder that all calibrated images lie below.
std::filesystem::path common_image_folder(const Scene& scene);

}  // namespace axial::io
