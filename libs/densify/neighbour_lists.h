// SPDX-License-Identifier: GPL-3.0-or-later
// Text files of neighbours, one line for each image: its index in the scene, then the indices of
// its neighbours, best first. '#' begins a comment.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace axial::densify {

// Replaces the neighbours of the images that the file names by the file's neighbours, with the
// scores that OpenMVS gives them (scale 1, 15 degrees, area 0.5, score 3). Other images keep their
// neighbours. Returns for each image whether it was named. Warns of neighbours without a pose,
// which are left out. Error that names file and line for an index that is no image, for an image
// that occurs twice or is its own neighbour, and for an image without neighbours.
std::vector<bool> read_neighbour_lists(const std::filesystem::path& file, Scene& scene);

// Writes the lists of all calibrated images that have neighbours.
void write_neighbour_lists(const std::filesystem::path& file, const Scene& scene);

}  // namespace axial::densify
