// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "densify/project.h"

namespace axial::densify {

// A fingerprint of everything that the depth maps depend on: all members of the settings of
// matching and filters, cameras, poses, contents of the files of images and masks, neighbours,
// sources and sparse points. A new member of these settings does not change the fingerprint while
// it has its default, so that existing maps stay valid. Settings that only fusion uses, and the
// number of threads, are not part of it. Reads the files of all calibrated images. Error for a file
// that cannot be read.
std::string fingerprint(const Project& project, const Settings& settings);

}  // namespace axial::densify
