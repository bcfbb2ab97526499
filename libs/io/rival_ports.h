// SPDX-License-Identifier: GPL-3.0-or-later
// Two sources of ports for the same images, of which one is taken.
#pragma once

#include <filesystem>
#include <string>

#include "io/colmap.h"
#include "io/housing.h"
#include "scene/scene.h"

namespace axial::io {

// Whether no number of the two differs by more than 1e-9.
bool same_port(const HousingPort& a, const HousingPort& b);

// The first image of `model` that `other` gives a port, and `taken` another or none; empty if there
// is none. For ports that cameras carry (housing_of): a camera without one says nothing.
std::string image_with_other_port(const Housing& taken, const Housing& other,
                                  const ColmapModel& model);

// A warning that `taken_from` is taken and `other_from` is not, with the image that
// image_with_other_port finds, if it finds one.
void warn_of_other_ports(const Housing& taken, const std::string& taken_from, const Housing& other,
                         const std::string& other_from, const ColmapModel& model);

// Whether `housing` has ports, and gives none of the model's images one.
bool gives_no_image_a_port(const Housing& housing, const ColmapModel& model);

// A warning if the housing file beside `scene_path` is there, is not `file`, from which `taken` was
// read, and gives some image of the scene another port, or none, or cannot be read.
void warn_of_housing_beside(const Scene& scene, const std::filesystem::path& scene_path,
                            const Housing& taken, const std::filesystem::path& file);

}  // namespace axial::io
