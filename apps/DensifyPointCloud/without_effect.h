// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "project.h"

namespace densify {

// A warning, in one line for each cause, of the options that were given and that change nothing
// with the others that were given. Options of OpenMVS that change nothing here say so elsewhere.
void warn_of_options_without_effect(const Options& options);

// The same for options that a scene without ports leaves without effect. `project` has its ports.
void warn_of_options_without_effect(const Project& project, const Options& options);

// The same for --estimate-roi where the scene has a region of interest of its own.
void warn_of_region_of_scene(const Options& options);

}  // namespace densify
