// SPDX-License-Identifier: GPL-3.0-or-later
// The file beside a scene that describes the distortion of the lenses, which the .mvs format cannot
// store.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "axial/base.h"
#include "refractive/lens_distortion.h"
#include "scene/scene.h"

namespace axial::io {

// The distortions of the lenses of a scene, and the lens of each image. attach_lenses() says how an
// image finds its lens.
struct SceneLenses {
  std::map<std::string, refractive::LensDistortion<double>> lenses;  // by name, never "none"
  std::string default_lens = "none";          // a name in `lenses`, or "none": no distortion
  std::map<std::string, std::string> images;  // end of an image's path -> lens name
};

// Returns the path "<scene without extension>.lenses.json".
std::filesystem::path lenses_beside(const std::filesystem::path& scene_path);

// Read and write the file of the lenses. write_lenses() replaces an existing file, does not check
// `lenses`, and gives an Error if the file cannot be written. read_lenses() gives an Error that
// names the file, the key and the value for a file that cannot be read, an unknown or missing key,
// a wrong type, a lens name that is not defined, a version other than 1, or numbers that are not
// possible.
SceneLenses read_lenses(const std::filesystem::path& path);
void write_lenses(const std::filesystem::path& path, const SceneLenses& lenses);

// Attaches lenses to the calibrated images of `scene`. The entry of an image in `lenses.images` is
// the longest entry that is the end of the image's path in whole path components. An entry that is
// the whole path of another image does not count. An image without an entry gets
// `lenses.default_lens`. Warns through `context` of entries that match no image. All messages start
// with `file`.
// Precondition: each name in `lenses` is defined or "none". Error if several images share an entry,
// or if a lens does not image a direction at the image centre, or mirrors the image there.
void attach_lenses(Scene& scene, const SceneLenses& lenses, const std::filesystem::path& file,
                   const Context& context = {});

// Attaches the lenses of the file beside the scene, if there is one. Returns true if the file
// exists and any image has a distorted lens. Warnings and errors as for read_lenses() and
// attach_lenses().
bool attach_lenses_beside(Scene& scene, const std::filesystem::path& scene_path,
                          const Context& context = {});

// Returns the lenses of the calibrated images of `scene`, for the file beside `scene_path`. The
// lenses are named "lens_1", "lens_2" and so on. Readers of the file assign a lens to an image by
// the end of the image's path. Error if this rule would give an image a wrong lens.
SceneLenses lenses_of(const Scene& scene, const std::filesystem::path& scene_path);

// Writes the file of the lenses beside the scene. The file is written if a lens is distorted or if
// `behind_ports` is true. Otherwise an existing file is removed. Error if the file cannot be
// written. The file is written even without distorted lenses if `behind_ports` is true: images
// behind ports usually have distorted lenses, so a missing file would look like a lost file.
void write_lenses_beside(const std::filesystem::path& scene_path, const SceneLenses& lenses,
                         bool behind_ports);

}  // namespace axial::io
