// SPDX-License-Identifier: GPL-3.0-or-later
// The file beside a scene that says how its images' lenses are distorted: .mvs has no place for it.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "refractive/lens_distortion.h"
#include "scene/scene.h"

namespace axial::io {

struct Lenses {
  std::map<std::string, refractive::LensDistortion<double>> lenses;
  std::string default_lens = "none";          // "none": straight
  std::map<std::string, std::string> images;  // image name -> lens name, as Housing::images
};

// "<scene without extension>.lenses.json".
std::filesystem::path lenses_beside(const std::filesystem::path& scene_path);

// Error that names file, key and value: unknown keys, wrong types, a lens name that is not defined,
// a version other than 1, numbers no lens has.
Lenses read_lenses(const std::filesystem::path& path);
void write_lenses(const std::filesystem::path& path, const Lenses& lenses);

// Gives the scene's images their lenses, by their paths. A warning for entries that no image goes
// by. Error that starts with `file` for a lens that shows its image's centre not at all, or turned
// over.
void attach_lenses(Scene& scene, const Lenses& lenses, const std::filesystem::path& file);

// The file beside the scene, if there is one, attached. True if any image has a distorted lens.
bool attach_lenses_beside(Scene& scene, const std::filesystem::path& scene_path);

// What the scene's images have, for the file beside `scene_path`. Error for images that the ends of
// their paths do not tell apart.
Lenses lenses_of(const Scene& scene, const std::filesystem::path& scene_path);

// Writes the file beside the scene. If all lenses are straight it says so `behind_ports`, where
// images are seldom undistorted and a lost file would be missed; in air none is left then.
void write_lenses_beside(const std::filesystem::path& scene_path, const Lenses& lenses,
                         bool behind_ports);

}  // namespace axial::io
