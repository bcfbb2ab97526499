// SPDX-License-Identifier: GPL-3.0-or-later
// Text files of neighbours, with one line for each image: the index of the image in the scene, then
// the indices of its neighbours, best first. '#' begins a comment.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace axial::densify {

// Reads the file and replaces the neighbours of each image that has a line in the file. The new
// neighbours get the values that OpenMVS gives them (ViewScore: scale 1, angle 15 degrees, area
// 0.5, score 3). Images without a line keep their neighbours. Returns, for each image of the scene,
// whether it has a line. Neighbours without a pose are left out with a warning. Throws an Error,
// which names file and line,
// - for an index that is no image of the scene,
// - for an image that has two lines or is its own neighbour,
// - for a line without neighbours.
std::vector<bool> read_neighbour_lists(const std::filesystem::path& file, Scene& scene);

// Writes the lists of all calibrated images that have neighbours.
void write_neighbour_lists(const std::filesystem::path& file, const Scene& scene);

}  // namespace axial::densify
