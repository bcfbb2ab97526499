// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "base/unused_input.h"
#include "pose/adjust.h"

// What --scale-from says, into `adjust`, each known to within `sigma` [m]:
//
//     images:NAME,NAME,METRES   the distance of two camera centres
//     points:ID,ID,METRES       of two points of the model
//     positions:FILE            camera centres, a file of io::read_positions; at least three, and
//                               not all on one line
//
// A NAME with commas stands in double quotes, with "" for a quote; without them it is understood
// where the model's names leave one way to read it.
// Error that names the option or file, and what is wrong with it. What is right but of no use with
// this model (no such image or point, both ends in one place, too few positions, or on one line) is
// reported to `unused` and leaves `adjust` as it is. Of positions, those of images without a pose
// are passed over with a warning each: a survey's list may name more photographs.
void add_known(const std::string& scale_from, double sigma,
               const std::filesystem::path& working_folder, const axial::pose::Bundle& bundle,
               axial::pose::AdjustOptions& adjust, axial::UnusedInput& unused);
