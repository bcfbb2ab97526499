// SPDX-License-Identifier: GPL-3.0-or-later
// Compares two sources of ports for the same images, of which only one is used. A source is, for
// example, a housing file or the cameras of a COLMAP model.
#pragma once

#include <filesystem>
#include <string>

#include "axial/base.h"
#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"
#include "scene/scene.h"

namespace axial::io {

// True if the two ports are of the same kind and none of their numbers (metres, indices and
// components of normals) differs by more than 1e-9.
bool same_port(const HousingPort& a, const HousingPort& b);

// Returns the name of the first image of `model` that has a port in `other`, but has another port
// or no port in `taken`, the source that is used. The result is empty if there is no such image. An
// image without a port in `other` is never returned, because a COLMAP camera without a port makes
// no statement about the port.
std::string image_with_other_port(const Housing& taken, const Housing& other,
                                  const ColmapModel& model);

// Warns through `context` if image_with_other_port finds an image. The warning names the image and
// states that the ports of `taken_from` are used and those of `other_from` are ignored.
// `taken_from` and `other_from` are words or file names for the user.
void warn_of_other_ports(const Housing& taken, const std::string& taken_from, const Housing& other,
                         const std::string& other_from, const ColmapModel& model,
                         const Context& context);

// True if `housing` has ports but none of the model's images gets one.
bool gives_no_image_a_port(const Housing& housing, const ColmapModel& model);

// Warns through `context` if the housing file beside `scene_path` cannot be read, or if it gives an
// image of the scene another port than `taken`, or a port where `taken` gives none, or the reverse.
// `file` is the file from which `taken` was read. There is no warning if no file lies beside
// `scene_path`, or if the file beside `scene_path` is `file`.
void warn_of_housing_beside(const Scene& scene, const std::filesystem::path& scene_path,
                            const Housing& taken, const std::filesystem::path& file,
                            const Context& context);

}  // namespace axial::io
