// SPDX-License-Identifier: GPL-3.0-or-later
// Loads the input of a run.
#pragma once

#include "densify/project.h"

namespace axial::densify {

// Loads the scene with its ports, and the points of the file `point_cloud` unless the path is
// empty. Fills the members of the scene, and `lenses`, which will be written beside the scene
// `output`. `for_export`: the points are only exported. Reads no image files. Throws an Error for
// any fault of the files that are read, and for too little memory to read them. `context` gets the
// lines of the readers.
Project load_scene(const survey::Options& survey, const std::filesystem::path& point_cloud,
                   const std::filesystem::path& output, bool for_export, const Context& context);

// Loads the scene, finds its images and masks, and selects views. Fills all members besides `part`
// and `fingerprint`. Of image files, the headers are kept. `observer`, unless it is empty, is
// called before views are selected. Throws an Error for a fault of the scene or its housing, for
// files that are missing or truncated, for images whose shape differs from their camera's, for an
// id that two images have, and if no image can get a depth map. survey::ImageStore::check_all()
// finds other faults of images.
Project load_project(const survey::Options& survey, const ViewOptions& options,
                     const std::filesystem::path& output, const SceneObserver& observer,
                     const Context& context);

}  // namespace axial::densify
