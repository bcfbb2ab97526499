// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "project.h"

namespace densify {

// Warns, in one line for each cause, of given options that have no effect because of other given
// options. OpenMVS's options that never have an effect here are reported in options.cpp.
void warn_of_options_without_effect(const Options& options);

// The same for options that have no effect on this project, for example in air.
void warn_of_options_without_effect(const Project& project, const Options& options);

// The same for --estimate-roi if the scene has its own region of interest.
void warn_of_region_of_scene(const Options& options);

}  // namespace densify
