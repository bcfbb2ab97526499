// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/context.h"
#include "options.h"

namespace axial::apps {

// For each lens in air behind its port, writes the lens with which COLMAP should start
// (pose/effective_lens.h), as a cameras.txt of COLMAP with the ids of the lenses: the option
// --effective-lens. Error that names the lens's file if a lens does not see through its port.
void write_effective_lenses(const Options& options, const Context& context);

}  // namespace axial::apps
