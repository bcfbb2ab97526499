// SPDX-License-Identifier: GPL-3.0-or-later
// The form in which a camera is written for the viewer (apps/ViewScene/page/src/project.js reads
// it).
#pragma once

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>
#include <span>

#include "scene/scene.h"

namespace axial::view {

// The pose, the lens and the port of an image, as a JSON object:
//   "size": width and height [px]
//   "rotation": the nine numbers of Pose::rotation, row by row; "centre": Pose::centre
//   "lens": fx, fy, cx, cy [px]
//   "distortion", if the lens has one: the members of LensDistortion, and "field", the largest |e|
//     that the lens sees (refractive/distorted_lens.h)
//   "port", if there is one: "kind" ("flat" or "dome"), "name", and the members of FlatPort or
//     DomePort; "indices" are those of air, glass and water
//   "corners": for the four corners of the image, the origin and the direction of their rays in the
//     scene's medium [world]
//   "check": for each of `points` [world] that the camera sees, its coordinates and its pixel, five
//     numbers; the viewer compares its own projection with them
nlohmann::ordered_json camera_data(const SceneImage& image,
                                   std::span<const Eigen::Vector3f> points);

}  // namespace axial::view
