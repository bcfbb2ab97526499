// SPDX-License-Identifier: GPL-3.0-or-later
// Reads and writes a scene file together with the files beside it. The files beside the scene hold
// the data that the .mvs format cannot store: the distortion of the lenses, the ports, and the
// origin of the coordinates.
#pragma once

#include <filesystem>
#include <optional>

#include "axial/io.h"
#include "io/cameras/housing.h"
#include "io/cameras/lenses.h"
#include "scene/local_frame.h"
#include "scene/scene.h"

namespace axial::io {

// The result of read_scene_with_cameras().
struct SceneWithCameras {
  Scene scene;                     // in `frame`; cameras have their lenses and ports
  LocalFrame frame;                // the frame of the scene's coordinates
  std::optional<Housing> housing;  // in world coordinates; empty if no image has a port
};

// Returns the path of the housing file: `files.housing`, or if it is empty, the path beside the
// scene. The file need not exist.
std::filesystem::path housing_file(const SceneFiles& files);

// Reads the scene, moves it into a frame near its cameras (enter_local_frame in geo_offset.h), and
// attaches lenses and ports. Paths of images and masks are found as by read_mvs() (mvs.h). The
// pixels of images are not read. Lines of `context` state the housing file and the numbers of
// images with ports and with distorted lenses. Warns through `context` if the scene has ports but
// no file of lenses. Error for a malformed file, if the scene or the file `files.housing` does not
// exist, if the ports do not meet `files.ports`, and if the file `files.housing` defines ports but
// gives no image one. With `files.allow_missing`, the last error is a warning.
SceneWithCameras read_scene_with_cameras(const SceneFiles& files, const Context& context);

// Writes the files of the housing, the lenses and the offset beside the scene `output`, where later
// programs look for them. If the scene has no housing, an existing housing file is removed. The
// offset file is written if scene.frame is not the world. If scene.frame is the world, an existing
// offset file is removed, except if `output` is the scene that was read. Lines of `context` name
// the files that are removed. The file of lenses is written or removed as in write_lenses_beside.
// The file housing_file(files), from which the ports were read, is never changed or removed.
// `lenses` is the result of lenses_of() for the scene and `output`.
void write_cameras_beside(const std::filesystem::path& output, const SceneWithCameras& scene,
                          const SceneLenses& lenses, const SceneFiles& files,
                          const Context& context);

}  // namespace axial::io
