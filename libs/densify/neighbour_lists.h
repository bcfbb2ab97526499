// SPDX-License-Identifier: GPL-3.0-or-later
// Text files of neighbours, with one line for each image: the index of the image in the scene, then
// the indices of its neighbours, best first. '#' begins a comment.
#pragma once

#include <filesystem>

#include "base/context.h"
#include "scene/scene.h"

namespace axial::densify {

// Reads the file and replaces the neighbours of each image that has a line in the file. The new
// neighbours get the values that OpenMVS gives them (ViewScore: scale 1, angle 15 degrees, area
// 0.5, score 3). Images without a line keep their neighbours. Lines that are empty or have only a
// comment are skipped. A repeated neighbour counts once. Returns, for each image of the scene,
// whether it has a line. Images without a pose are left out of the neighbours with a warning.
// Throws an Error, which names the file and, as far as it applies, the line,
// - if the file cannot be read,
// - for a word that is no index of an image of the scene,
// - for an image that has two lines or is its own neighbour,
// - for a line without neighbours.
std::vector<bool> read_neighbour_lists(const std::filesystem::path& file, Scene& scene,
                                       const Context& context = {});

// Writes the lists of all calibrated images that have neighbours, in the order of the scene. Throws
// an Error if the file cannot be written.
void write_neighbour_lists(const std::filesystem::path& file, const Scene& scene);

}  // namespace axial::densify
