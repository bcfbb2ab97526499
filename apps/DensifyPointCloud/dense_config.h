// SPDX-License-Identifier: GPL-3.0-or-later
// The file of --dense-config-file: OpenMVS's settings that have no option. Each line has the form
// "Title = value".
#pragma once

#include <filesystem>

#include "axial/densify.h"

namespace axial::apps {

// Sets the values that the file names. If the file does not exist, it is written with the current
// values, as OpenMVS does. Section lines "[...]", braces, and comments after '#' or ';' are
// ignored. The log gets one line each for unknown titles (a warning), for titles that have no
// effect in this program, and for titles whose setting has an option. In the last case the option
// takes precedence, as in OpenMVS. Error that names file and line for a line without '=', and for a
// value that is no number or out of range.
void apply_dense_config(const std::filesystem::path& file, densify::Options& settings);

}  // namespace axial::apps
