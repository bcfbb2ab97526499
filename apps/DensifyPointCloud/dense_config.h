// SPDX-License-Identifier: GPL-3.0-or-later
// --dense-config-file: OpenMVS's file of settings that have no option, "Title = value" a line.
#pragma once

#include <filesystem>

#include "options.h"

namespace densify {

// Sets what the file names, and says in one warning line each which titles are unknown, which are
// known but change nothing here, and which are those of options, which count instead, as in
// OpenMVS. Section lines "[...]", braces, and comments after '#' or ';' are passed over. A file
// that is not there is written with the values in use, as OpenMVS does. Error that names file, line
// and title for a line without '=' and for a value that is no number, or out of range.
void apply_dense_config(const std::filesystem::path& file, Options& options);

}  // namespace densify
