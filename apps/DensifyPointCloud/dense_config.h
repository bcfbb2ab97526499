// SPDX-License-Identifier: GPL-3.0-or-later
// --dense-config-file: OpenMVS's file of settings that have no option, one "Title = value" a line.
#pragma once

#include <filesystem>

#include "densify/settings.h"

namespace axial::apps {

// Sets the values that the file names. Logs one line each for titles that are unknown (a warning),
// for titles that have no effect here, and for titles of options; options take precedence, as in
// OpenMVS. Section lines "[...]", braces, and comments after '#' or ';' are ignored. If the file
// does not exist, it is written with the current values, as OpenMVS does. Error that names file and
// line for a line without '=', and for a value that is no number or out of range.
void apply_dense_config(const std::filesystem::path& file, densify::Settings& settings);

}  // namespace axial::apps
