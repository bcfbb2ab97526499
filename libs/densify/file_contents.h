// SPDX-License-Identifier: GPL-3.0-or-later
// Fingerprints of the photographs and masks of a run. A file keeps the fingerprints, so that a run
// for one part of the images need not read all photographs of a survey.
#pragma once

#include <string>
#include <vector>

#include "densify/project.h"

namespace axial::densify {

// Returns, for each view, a fingerprint of the bytes of its photograph and of its mask; empty for
// images without calibration. Reads the photographs and masks, with one exception: if
// Settings::until, tile or plan is given, photographs and masks whose names, sizes and times of
// change are in the file depth_inputs.json of the working folder get their fingerprints from this
// file. Runs with `until` or `plan` for all images write the file. A damaged file counts as empty.
// Throws an Error for a photograph or mask that cannot be read, and if the file cannot be written.
std::vector<std::string> contents_of_views(const Project& project, const Settings& settings);

}  // namespace axial::densify
