// SPDX-License-Identifier: GPL-3.0-or-later
// Converts a scene to a COLMAP model.
#pragma once

#include <filesystem>

#include "io/colmap/colmap.h"
#include "scene/scene.h"

namespace axial::io {

// Returns a model with the calibrated images of `scene`, their cameras, and the sparse points.
// Images with equal cameras share one camera of the model. The camera model is PINHOLE, or for a
// distorted lens the result of lens::model_of. A camera keeps its port. Cameras and points have the
// ids 1, 2, 3, ... The images keep their order, and the id of an image is SceneImage::id plus one.
// Image names are paths relative to `image_folder`.
//
// A scene does not keep the measured observations. Each observation of the model is therefore the
// projection of its sparse point. Observations of points that the camera does not see are left out.
// Points that no camera sees are left out too.
//
// Error that names the image for a lens that no model of COLMAP describes, a path outside
// `image_folder`, or two images with the same name.
ColmapModel export_colmap_model(const Scene& scene, const std::filesystem::path& image_folder);

// Returns the deepest folder that contains, at any depth, all calibrated images of `scene`. The
// result is an empty path if there are no such images.
std::filesystem::path common_image_folder(const Scene& scene);

}  // namespace axial::io
