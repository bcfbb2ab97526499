// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/openmvs/scene_options.h"

#include "base/error.h"
#include "base/program/unused_input.h"

namespace axial::io {
namespace {

PortChoice port_choice(const SceneOptions& options) {
  if (options.camera_model == "auto")
    return options.refractive ? PortChoice::required : PortChoice::automatic;
  if (options.camera_model == "flatport") return PortChoice::flat;
  if (options.camera_model != "pinhole")
    fail("--camera-model {}: must be one of auto, pinhole, flatport", options.camera_model);
  if (options.refractive) fail("--refractive contradicts --camera-model pinhole");
  if (!options.housing.empty())
    fail("--housing {} contradicts --camera-model pinhole", options.housing);
  return PortChoice::ignored;
}

}  // namespace

void declare_scene_options(OptionList& list, SceneOptions& options) {
  list.add_switch("refractive", &options.refractive,
                  "cameras are behind ports: require a housing file")
      .add("housing", &options.housing, "housing file (<scene>.housing.json)")
      .add_with_default("camera-model", &options.camera_model,
                        "auto: as in the housing file, pinhole: ignore the housing file, flatport: "
                        "require a flat port for every image")
      .sets("camera is flat_port", " is flatport");
  UnusedInput::declare(list, options.allow_missing);
}

SceneFiles scene_files(const SceneOptions& options, const std::string& input,
                       const ParsedOptions& parsed) {
  const CommonOptions& common = parsed.common;
  SceneFiles files{in_working_folder(common, input), common.working_folder,
                   in_working_folder(common, options.housing), port_choice(options)};
  files.allow_missing = options.allow_missing;
  return files;
}

}  // namespace axial::io
