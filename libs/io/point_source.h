// SPDX-License-Identifier: GPL-3.0-or-later
// A cloud in place of a scene's sparse points: what -p of OpenMVS's programs gives.
#pragma once

#include <filesystem>

#include "scene/local_frame.h"
#include "scene/scene.h"

namespace axial::io {

// Replaces points, normals and colours of a scene in `frame`. The cloud counts from where its
// comment geo_offset says. Without such a comment it is in the world or in `frame`, whichever is
// nearer to it: OpenMVS's programs keep coordinates and drop comments. The cloud is a PLY with
// view_indices, images of the scene, and view_weights if it has them. Error that names the file for
// a cloud without views, a view of an image that the scene does not have, or a point that is not
// finite.
void use_point_cloud(Scene& scene, const LocalFrame& frame, const std::filesystem::path& ply);

}  // namespace axial::io
