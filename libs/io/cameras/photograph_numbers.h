// SPDX-License-Identifier: GPL-3.0-or-later
// A number of each photograph, such as its time or its exposure, from a file that a user writes.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace axial::io {

// The number of each photograph by its name.
using PhotographNumbers = std::map<std::string, double>;

// Reads a file with a line NAME,NUMBER for each photograph. `column`: what the numbers are, for
// errors and for the heading, such as "seconds". The number follows the last comma, so that names
// may contain commas. Empty lines, lines that begin with '#', and a first line "name,<column>" are
// skipped. Error that names the file and the line for a line of another form, a number that is not
// finite, and a name that occurs twice; error for a file without a photograph.
PhotographNumbers read_photograph_numbers(const std::filesystem::path& file,
                                          std::string_view column);

}  // namespace axial::io
