// SPDX-License-Identifier: GPL-3.0-or-later
// Text files of neighbours, a line an image: its index in the scene, then those of its neighbours,
// best first. '#' begins a comment.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace densify {

// Gives the images that the file names the neighbours that it names, with the scores that OpenMVS
// gives them (scale 1, 15 degrees, area 0.5, score 3); the others keep theirs. Returns for each
// image whether it was named. Error that names file and line for an index that is no image, an
// image twice, an image that is its own neighbour, or one without neighbours.
std::vector<bool> read_neighbour_lists(const std::filesystem::path& file, axial::Scene& scene);

// Every calibrated image that has neighbours.
void write_neighbour_lists(const std::filesystem::path& file, const axial::Scene& scene);

}  // namespace densify
