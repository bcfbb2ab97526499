// SPDX-License-Identifier: GPL-3.0-or-later
// The file of targets, in the format of its name.
#pragma once

#include <span>

#include "control/control.h"
#include "options.h"
#include "targets/targets_file.h"

namespace axial::apps {

// Reads the points and bars of --control, and logs how they were understood. Throws an Error for
// files that cannot be read, and for several files that state points in different systems or a
// point twice.
control::Control read_known(const Options& options);

// Writes `found` to --output-file: OpenDroneMap's gcp_list.txt (.txt), Metashape's markers (.xml),
// otherwise targets.json. `known`: the points and bars that the first two hold as well.
void write_output(const Options& options, std::span<const targets::Photograph> found,
                  control::Control known);

}  // namespace axial::apps
