// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "densify/project.h"

namespace axial::densify {

// A fingerprint of everything that the depth maps depend on: all members of the settings of
// matching and filters, cameras, poses, the contents of image files and mask files, neighbours,
// sources and sparse points. If a later version adds a member to these settings, the fingerprint
// changes only when the member differs from its default, so that existing maps stay valid. The
// number of threads and the settings that only fusion uses do not change the fingerprint. Reads
// the image and mask files of all calibrated images. Error for a file that cannot be read.
std::string fingerprint(const Project& project, const Settings& settings);

// A fingerprint of the cameras, poses and pixels of all views at the working resolution, with their
// masks. `project` needs no more than load_scene_and_headers() loads. Reads the image and mask
// files of all calibrated images. Error for a file that cannot be read.
std::string fingerprint_of_views(const Project& project, const Settings& settings);

}  // namespace axial::densify
