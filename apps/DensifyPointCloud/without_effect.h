// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "options.h"

namespace axial::apps {

// Warns of given options that have no effect because of other given options. There is one line for
// each cause. Options of OpenMVS that never have an effect in this program are reported elsewhere,
// by parse_command_line().
void warn_of_options_without_effect(const Options& options);

// Warns of given options that have no effect on the scene, for example because it is in air.
void warn_of_options_without_effect(const Options& options, const densify::SceneFacts& facts);

}  // namespace axial::apps
