// SPDX-License-Identifier: GPL-3.0-or-later
// Converts a scene to a COLMAP model.
#pragma once

#include <filesystem>

#include "io/colmap/colmap.h"
#include "scene/scene.h"

namespace axial::io {

// Returns the calibrated images of `scene`, the sparse points, and one camera for each distinct
// camera, with its port if it has one: PINHOLE, or the model of its distorted lens
// (lens::model_of). The id of an image is the scene's id plus one.
// Image names are relative to `image_folder`.
//
// A scene does not keep the measured observations, so each observation is the projection of its
// point. Observations that the camera does not see are left out, and points without any
// observation. Error that names the image for a lens that no model of
// COLMAP describes, a path outside `image_folder`, or
// two images with the same name.
ColmapModel export_colmap_model(const Scene& scene, const std::filesystem::path& image_folder);

// Returns the deepest folder that contains all calibrated images; an empty path if there are none.
std::filesystem::path common_image_folder(const Scene& scene);

}  // namespace axial::io
