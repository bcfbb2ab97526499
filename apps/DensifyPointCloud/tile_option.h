// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "options.h"

namespace axial::apps {

// Takes the values of --fusion-tiles, which is in `options` already, and of --tile: `tile` is empty
// or "I/N". Throws an Error that names the option and its value if a value is malformed or out of
// range, or if the options contradict others. To be called when all other settings are complete.
void take_tiles(const std::string& tile, Options& options);

}  // namespace axial::apps
