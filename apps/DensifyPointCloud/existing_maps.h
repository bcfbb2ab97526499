// SPDX-License-Identifier: GPL-3.0-or-later
// Depth maps that lie in the working folder before a run: this program's own, which are resumed and
// replaced, and other programs', which are not overwritten unless --overwrite-dmaps says so.
#pragma once

#include <string>
#include <vector>

#include "io/dmap.h"
#include "project.h"

namespace densify {

// What lies under the name of each image's map, one an image of the scene. Images that are to get
// no map of their own count as DmapOrigin::none.
using ExistingMaps = std::vector<axial::io::DmapStatus>;

ExistingMaps find_existing_maps(const Project& project, const Options& options);

// How a map of this origin is read: a foreign one may lie beside an older side file of ours.
axial::io::DmapSide side_to_read(axial::io::DmapOrigin origin);

// The image's final map, without normals if its file has none. With --fusion-mode -1 it has no
// depth where `mask` (of its size; empty: all stay) is zero; maps made by this run are masked
// already. The file stays as it is.
axial::DepthMap read_final_map(const Project& project, const Options& options,
                               const ExistingMaps& maps, std::size_t image, const cv::Mat1b& mask);

// Error that names a foreign map and what to do, unless --overwrite-dmaps is given; a line for each
// damaged map.
void check_overwriting(const Project& project, const Options& options, const ExistingMaps& maps);

// For --fusion-mode -1: only images with a map stay among the references, and are worked on at
// their map's resolution. Error if there is no map, and for maps that are damaged, of another pose
// or lens than their image, or foreign where the image has a port or a distorted lens.
void keep_images_with_maps(Project& project, const Options& options, const ExistingMaps& maps);

}  // namespace densify
