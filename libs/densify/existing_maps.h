// SPDX-License-Identifier: GPL-3.0-or-later
// Depth maps in the working folder before a run. This program's own maps are resumed and replaced.
// Maps of other programs are not overwritten without --overwrite-dmaps.
#pragma once

#include <string>
#include <vector>

#include "io/dmap.h"
#include "project.h"

namespace densify {

// The state of each image's map file, one for each image of the scene. Images that are not
// references count as DmapOrigin::none.
using ExistingMaps = std::vector<axial::io::DmapStatus>;

ExistingMaps find_existing_maps(const Project& project, const Options& options);

// How to read a map of this origin: a foreign map may lie beside an older side file of this
// program, which is then ignored.
axial::io::DmapSide side_to_read(axial::io::DmapOrigin origin);

// Reads the image's final map, without normals if its file has none. With --fusion-mode -1 the map
// has no depth where `mask` is zero (same size as the map; empty: no mask); maps made by this run
// are masked already. The file is not changed.
axial::DepthMap read_final_map(const Project& project, const Options& options,
                               const ExistingMaps& maps, std::size_t image, const cv::Mat1b& mask);

// Warns of each damaged map. Error that names a foreign map and the possible remedies, unless
// --overwrite-dmaps is given.
void check_overwriting(const Project& project, const Options& options, const ExistingMaps& maps);

// For --fusion-mode -1: keeps only images with a map among the references, and sets their cameras
// to the resolution of their maps. Error if there is no map, for a damaged map, for a map with
// another pose or lens than its image, and for a foreign map of an image with a port or a distorted
// lens.
void keep_images_with_maps(Project& project, const Options& options, const ExistingMaps& maps);

}  // namespace densify
