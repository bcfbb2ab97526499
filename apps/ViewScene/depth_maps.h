// SPDX-License-Identifier: GPL-3.0-or-later
// The depth maps of the photographs as pictures for the page.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "base/context.h"
#include "scene/scene.h"

namespace axial::apps {

struct DepthMapOptions {
  std::filesystem::path folder;  // with the files depthNNNN.dmap
  bool is_given = false;         // the user named the folder
  int longest_side = 512;        // of the pictures [px]; 0: no pictures
};

// Writes pictures of the depth map of each calibrated image to the folder "depth" of `staging`.
// Returns a list with an entry for each calibrated image, in the order of the scene: null if it has
// no depth map, otherwise an object with "depth", "normal" and "confidence". Each of them has a
// "file" and, but for normals, "low", "high" and "colors": the colours from the value `low` to the
// value `high`. Normals and confidences are left out if the map has none. Returns an empty list if
// no image has a depth map.
//
// Error that names the file if a depth map cannot be read, or if it belongs to another photograph,
// and Error if there is no depth map in a folder that the user named. If the user did not name the
// folder, these are warnings, and such maps are left out.
nlohmann::ordered_json write_depth_maps(const Scene& scene, const DepthMapOptions& options,
                                        const std::filesystem::path& staging,
                                        const Context& context);

}  // namespace axial::apps
