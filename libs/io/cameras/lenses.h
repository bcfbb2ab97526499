// SPDX-License-Identifier: GPL-3.0-or-later
// The file beside a scene that describes the distortion of its lenses. The .mvs format cannot store
// it.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "refractive/lens_distortion.h"
#include "scene/scene.h"

namespace axial::io {

// The distortions of the lenses of a scene, and the lens of each image.
struct SceneLenses {
  std::map<std::string, refractive::LensDistortion<double>> lenses;
  std::string default_lens = "none";          // "none": no distortion
  std::map<std::string, std::string> images;  // image name -> lens name, as Housing::images
};

// "<scene without extension>.lenses.json".
std::filesystem::path lenses_beside(const std::filesystem::path& scene_path);

// Read and write the file. Error of reading that names the file, the key and the value for an
// unknown key, a wrong type, a lens name that is not defined, a version other than 1, or numbers
// that are not possible.
SceneLenses read_lenses(const std::filesystem::path& path);
void write_lenses(const std::filesystem::path& path, const SceneLenses& lenses);

// Attaches lenses to the calibrated images of the scene, found by the ends of the image paths (as
// in attach_ports). Warns of entries that match no image. Error that starts with `file` if a lens
// does not show the image centre or shows it mirrored.
void attach_lenses(Scene& scene, const SceneLenses& lenses, const std::filesystem::path& file);

// Attaches the lenses of the file beside the scene, if there is one. Returns true if the file
// exists and any image has a distorted lens.
bool attach_lenses_beside(Scene& scene, const std::filesystem::path& scene_path);

// Returns the lenses of the scene's images, for the file beside `scene_path`. Error if an image
// would get the lens of another one because of the end of its path.
SceneLenses lenses_of(const Scene& scene, const std::filesystem::path& scene_path);

// Writes the file beside the scene. If no lens is distorted, the file is written only if
// `behind_ports`: there images are rarely undistorted, so that a missing file could mean a lost
// one. In air an existing file is removed then.
void write_lenses_beside(const std::filesystem::path& scene_path, const SceneLenses& lenses,
                         bool behind_ports);

}  // namespace axial::io
