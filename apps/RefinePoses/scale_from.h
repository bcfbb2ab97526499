// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "base/unused_input.h"
#include "pose/adjust.h"

namespace axial::apps {

// Adds the known lengths that --scale-from names to `adjust`, each with the standard deviation
// `sigma` [m]. An empty `scale_from` adds nothing.
//
//     images:NAME,NAME,METRES   the distance of two camera centres
//     points:ID,ID,METRES       the distance of two points of the model
//     positions:FILE            camera centres, a file of io::read_positions; at least three, and
//                               not all on one line
//
// A NAME that contains a comma must be written in double quotes, and a double quote in it as "".
// The quotes may be left out if the list can be read in only one way, given the names of the model.
//
// Error that names the option or file, and the mistake. Input that is valid but cannot be used with
// this model (no such image or point, both ends in one place, too few positions, or all on one
// line) is reported to `unused`, and `adjust` stays as it is. Positions of images without a pose
// are skipped with a warning for each: the list of a survey may name more photographs.
void add_known(const std::string& scale_from, double sigma,
               const std::filesystem::path& working_folder, const pose::Bundle& bundle,
               pose::AdjustOptions& adjust, UnusedInput& unused);

}  // namespace axial::apps
