// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "pose/adjust.h"

// What --scale-from says, into `adjust`, each known to within `sigma` [m]:
//
//     images:NAME,NAME,METRES   the distance of two camera centres
//     points:ID,ID,METRES       of two points of the model
//     positions:FILE            camera centres, "NAME X Y Z" a line, # begins a comment; at least
//                               three, and not all on one line
//
// Error that names the option or file, and what is wrong with it.
void add_known(const std::string& scale_from, double sigma,
               const std::filesystem::path& working_folder, const axial::pose::Bundle& bundle,
               axial::pose::AdjustOptions& adjust);
