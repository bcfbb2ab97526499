// SPDX-License-Identifier: GPL-3.0-or-later
// Depth maps in the working folder before a run. Maps of this program are used again or replaced.
// Maps of other programs, called foreign, are not overwritten unless the options allow it.
#pragma once

#include <string>
#include <vector>

#include "densify/project.h"
#include "io/openmvs/dmap.h"

namespace axial::densify {

// The states of the final map files before a run.
struct ExistingMaps {
  // One for each image of the scene. Images without a known map have DmapOrigin::none.
  std::vector<io::DmapStatus> states;
  bool are_final = false;  // the run makes no maps (MatchOptions::make_maps is false)
};

// Reads the map files of the images Project::part, one after the other. Other images have
// DmapOrigin::none. Warnings as for io::dmap_status().
ExistingMaps find_existing_maps(const Project& project, bool make_maps,
                                const Context& context = {});

// Reads the final map of the image with the index `image`. If all normals of the map are 0,
// DepthMap::normal is empty. `mask`: empty (no mask), or of the map's size. In a run that makes no
// maps, depth, normal and confidence are set to 0 where `mask` is zero. In a run that makes maps,
// `mask` is not used, because these maps are masked already. The file is not changed. Throws an
// Error if the file cannot be read. Warnings as for io::read_dmap().
DepthMap read_final_map(const Project& project, const ExistingMaps& maps, std::size_t image,
                        const cv::Mat1b& mask, const Context& context);

// The text `made_from` (io/openmvs/dmap.h) of the final depth maps that a run with these options
// makes.
std::string final_made_from(const Project& project, const MatchOptions& options);

// Whether all references have complete final depth maps that this program made from the same input
// with the same options.
bool are_complete(const Project& project, const MatchOptions& options, const ExistingMaps& maps);

// Throws an Error unless are_complete(). The error names the first map that is not.
void require_final_maps(const Project& project, const MatchOptions& options,
                        const ExistingMaps& maps);

// For runs that make maps: checks whether existing maps may be overwritten. Warns of each damaged
// map. Throws an Error if a map is foreign, unless `overwrite` is true
// (MatchOptions::overwrite_dmaps). The error names one foreign map and the possible remedies.
void check_overwriting(const Project& project, bool overwrite, const ExistingMaps& maps,
                       const Context& context = {});

// For runs that make no maps: removes images without a map from Project::references. Sets the
// cameras of the kept images in Project::views to the resolution of their maps. `context` gets the
// number of images that have a map, as a warning if some have none. Throws an Error
// - if no reference has a map,
// - for a damaged map,
// - for a foreign map of an image whose camera has a port or a distorted lens,
// - for a map whose shape differs from the shape of the image's camera,
// - for a map with another pose or camera than the image. The test takes the points that the
//   corners and the centre of the map see in the middle of its depth range. The image's camera must
//   project each of them less than 1 px away from its pixel, at the map's resolution.
void keep_images_with_maps(Project& project, const ExistingMaps& maps, const Context& context = {});

}  // namespace axial::densify
