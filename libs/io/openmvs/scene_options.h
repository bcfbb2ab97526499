// SPDX-License-Identifier: GPL-3.0-or-later
// The options that name the cameras of a scene, which several programs have.
#pragma once

#include <filesystem>
#include <string>

#include "base/program.h"
#include "io/openmvs/scene_with_cameras.h"

namespace axial::io {

// The values of the options as text.
struct SceneOptions {
  std::string housing, camera_model = "auto";
  bool refractive = false, allow_missing = false;
};

// Adds --refractive, --housing, --camera-model and --allow-missing to `list`, bound to `options`,
// which must exist until parse_options() has returned.
void declare_scene_options(OptionList& list, SceneOptions& options);

// The files of the scene `input`, which may be relative to the working folder. Messages name the
// options. Error for an unknown camera model, and for options that contradict each other.
SceneFiles scene_files(const SceneOptions& options, const std::string& input,
                       const CommonOptions& common);

}  // namespace axial::io
