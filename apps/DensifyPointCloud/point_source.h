// SPDX-License-Identifier: GPL-3.0-or-later
// -p: another cloud in place of the scene's sparse points.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace densify {

// Replaces points, normals and colours. The cloud is a PLY with view_indices, images of the scene,
// and view_weights if it has them. Error that names the file for a cloud without views, a view of
// an image that the scene does not have, or a point that is not finite.
void use_point_cloud(axial::Scene& scene, const std::filesystem::path& ply);

}  // namespace densify
