// SPDX-License-Identifier: GPL-3.0-or-later
// Compares two sources of ports for the same images, of which only one is used.
#pragma once

#include <filesystem>
#include <string>

#include "io/cameras/housing.h"
#include "io/colmap/colmap.h"
#include "scene/scene.h"

namespace axial::io {

// True if the two ports are of the same kind and no number differs by more than 1e-9.
bool same_port(const HousingPort& a, const HousingPort& b);

// Returns the first image of `model` for which `other` has a port that differs from the port in
// `taken`, or for which `taken` has none; empty if there is no such image. An image without a port
// in `other` never counts, because a camera file without a port makes no statement (housing_of).
std::string image_with_other_port(const Housing& taken, const Housing& other,
                                  const ColmapModel& model);

// Warns that `taken_from` is used and `other_from` is not, if image_with_other_port finds an image.
// The warning names that image.
void warn_of_other_ports(const Housing& taken, const std::string& taken_from, const Housing& other,
                         const std::string& other_from, const ColmapModel& model);

// True if `housing` has ports but none of the model's images gets one.
bool gives_no_image_a_port(const Housing& housing, const ColmapModel& model);

// Warns if there is a housing file beside `scene_path` that differs from `taken` for an image of
// the scene, or that cannot be read. No warning if that file is `file`, from which `taken` was
// read.
void warn_of_housing_beside(const Scene& scene, const std::filesystem::path& scene_path,
                            const Housing& taken, const std::filesystem::path& file);

}  // namespace axial::io
