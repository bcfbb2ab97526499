// SPDX-License-Identifier: GPL-3.0-or-later
// Labels of targets that were printed by other programs, whose lists have other numbers.
#pragma once

#include <filesystem>

#include "targets/codes/family.h"

namespace axial::targets {

// Reads a table with a line CODE,LABEL for each target, and sets Family::labels. CODE is what the
// target shows (code_of()); the code of a ring may be read from any of its segments. Empty lines
// and comments (#) are skipped. Throws an Error that names the file and the line for a file that
// cannot be read, another form, a code that the family does not have, and for a code or a label
// that occurs twice. Precondition: `family` is no board.
void read_target_table(const std::filesystem::path& file, Family& family);

}  // namespace axial::targets
