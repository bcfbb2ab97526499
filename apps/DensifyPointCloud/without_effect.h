// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "densify/scene_facts.h"
#include "options.h"

namespace axial::apps {

// Warns, in one line for each cause, of given options that have no effect because of other given
// options. OpenMVS's options that never have an effect here are reported in options.cpp.
void warn_of_options_without_effect(const Options& options);

// The same for options that have no effect on this scene, for example in air.
void warn_of_options_without_effect(const Options& options, const densify::SceneFacts& facts);

}  // namespace axial::apps
