// SPDX-License-Identifier: GPL-3.0-or-later
// Depth maps in the working folder before a run. This program's own maps are resumed and replaced.
// Maps of other programs are not overwritten unless the settings allow it.
#pragma once

#include <string>
#include <vector>

#include "densify/project.h"
#include "io/openmvs/dmap.h"

namespace axial::densify {

// The state of each image's map file, one for each image of the scene. Images that are not
// references count as DmapOrigin::none.
using ExistingMaps = std::vector<io::DmapStatus>;

ExistingMaps find_existing_maps(const Project& project, const Settings& settings);

// How to read a map of this origin: a foreign map may lie beside an older side file of this
// program, which is then ignored.
io::DmapSide side_to_read(io::DmapOrigin origin);

// Reads the image's final map, without normals if its file has none. If no maps are made, the map
// has no depth where `mask` is zero (same size as the map; empty: no mask); maps made by this run
// are masked already. The file is not changed.
DepthMap read_final_map(const Project& project, const Settings& settings, const ExistingMaps& maps,
                        std::size_t image, const cv::Mat1b& mask);

// Warns of each damaged map. Error that names a foreign map and the possible remedies, unless
// overwrite_dmaps is set.
void check_overwriting(const Project& project, const Settings& settings, const ExistingMaps& maps);

// For runs that make no maps: keeps only images with a map among the references, and sets their
// cameras to the resolution of their maps. Error if there is no map, for a damaged map, for a map
// with another pose or lens than its image, and for a foreign map of an image with a port or a
// distorted lens.
void keep_images_with_maps(Project& project, const Settings& settings, const ExistingMaps& maps);

}  // namespace axial::densify
