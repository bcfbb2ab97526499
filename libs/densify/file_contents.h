// SPDX-License-Identifier: GPL-3.0-or-later
// Fingerprints of the photographs and masks of a run, kept in a file, so that the runs of a
// thousand parts do not each read all photographs of a survey.
#pragma once

#include <string>
#include <vector>

#include "densify/project.h"

namespace axial::densify {

// Returns, for each view, a fingerprint of the bytes of its photograph and of its mask; empty for
// images without calibration. If Settings::until, tile or plan is given, the fingerprints are
// taken from the file depth_inputs.json in the working folder, for photographs and masks whose
// names, sizes and times of change are those of the file. Runs for all
// images then write this file. In all other cases, reads the photographs and masks. Throws an Error
// for a photograph or mask that cannot be read, and if depth_inputs.json cannot be written. A
// damaged depth_inputs.json counts as empty.
std::vector<std::string> contents_of_views(const Project& project, const Settings& settings);

}  // namespace axial::densify
