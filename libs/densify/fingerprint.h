// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "densify/project.h"

namespace axial::densify {

// Returns a fingerprint of everything that the depth maps depend on, as 32 hex digits: all members
// of the settings of matching and filters, cameras, poses, the contents of image files and mask
// files, neighbours, sources and sparse points. A member that a later version adds to these
// settings changes the fingerprint only if it differs from its default. So existing maps stay
// valid. The number of threads and the settings that only fusion uses do not change the
// fingerprint. Reads the image and mask files of all calibrated images. `project`: its views must
// be selected. Throws an Error for a file that cannot be read.
std::string fingerprint(const Project& project, const Settings& settings);

}  // namespace axial::densify
