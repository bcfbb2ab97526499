// SPDX-License-Identifier: GPL-3.0-or-later
// Command-line options that several programs share: they choose how the cameras of a scene are
// modelled.
#pragma once

#include <filesystem>
#include <string>

#include "base/program/program.h"
#include "io/openmvs/scene_with_cameras.h"

namespace axial::io {

// The values of the options --housing, --camera-model, --refractive and --allow-missing, as the
// user gave them. An empty `housing` means that the option was not given.
struct SceneOptions {
  std::string housing, camera_model = "auto";
  bool refractive = false, allow_missing = false;
};

// Adds --refractive, --housing, --camera-model and --allow-missing to `list`. Their values are
// stored in `options`, which must exist until parse_options() has returned.
void declare_scene_options(OptionList& list, SceneOptions& options);

// Returns the files of the scene `input`. `input` and `options.housing` may be relative to the
// working folder of `parsed`. Messages about these files, and about the photographs and masks of
// the scene, call settings by the names of options. Error for a camera model other than auto,
// pinhole and flatport. Error if --refractive or --housing is combined with --camera-model pinhole.
SceneFiles scene_files(const SceneOptions& options, const std::string& input,
                       const ParsedOptions& parsed);

}  // namespace axial::io
