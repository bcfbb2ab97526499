// SPDX-License-Identifier: GPL-3.0-or-later
// A scene file together with the files beside it, which describe what the .mvs format cannot store:
// the distortion of the lenses, the ports, and the origin of the coordinates.
#pragma once

#include <filesystem>
#include <optional>

#include "base/setting_names.h"
#include "io/cameras/housing.h"
#include "io/cameras/lenses.h"
#include "scene/local_frame.h"
#include "scene/scene.h"

namespace axial::io {

enum class PortChoice {
  automatic,  // the ports of the housing file, if there is one
  ignored,    // the housing file is not read
  required,   // a housing file must exist and give an image a port
  flat        // a housing file must exist and give every image a flat port
};

// The files of a scene. The paths are absolute; an empty path means "none", unless its comment says
// otherwise. The names of settings in errors are "allow_missing", "housing", "refractive" (for
// PortChoice::required) and "camera is flat_port" (for PortChoice::flat).
struct SceneFiles {
  std::filesystem::path scene;           // .mvs
  std::filesystem::path working_folder;  // base of relative image paths in the scene
  std::filesystem::path housing;         // empty: beside the scene, if there is one
  PortChoice ports = PortChoice::automatic;
  bool allow_missing = false;  // go on if the housing gives no image a port
  SettingNames name_of = own_name;
};

struct SceneWithCameras {
  Scene scene;                     // in `frame`; cameras have their lenses and ports
  LocalFrame frame;                // the frame of the scene's coordinates
  std::optional<Housing> housing;  // the source of the ports; in world coordinates
};

// The path of the housing file, which may not exist.
std::filesystem::path housing_file(const SceneFiles& files);

// Reads the scene, moves it into a frame near its cameras (enter_local_frame), and attaches lenses
// and ports. Image and mask paths that do not exist in the working folder are looked up relative to
// the scene's folder. The image files are not read. Logs what was found. Warns if the scene has
// ports but no file of lenses. Error for any fault of these files, and if `files.ports` is not met.
SceneWithCameras read_scene_with_cameras(const SceneFiles& files);

// Writes housing, lenses and offset beside the scene `output`, where later programs look for them.
// Removes such a file of the same name if the scene has no ports, distorted lenses or offset. The
// housing file of `files`, from which the scene was read, is never changed. `lenses`: lenses_of()
// the scene and `output`.
void write_cameras_beside(const std::filesystem::path& output, const SceneWithCameras& scene,
                          const SceneLenses& lenses, const SceneFiles& files);

}  // namespace axial::io
