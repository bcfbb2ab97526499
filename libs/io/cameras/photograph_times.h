// SPDX-License-Identifier: GPL-3.0-or-later
// The times at which photographs were taken, from a file that a user writes.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace axial::io {

// The time of each photograph by its name [s], from any start that all photographs share.
using PhotographTimes = std::map<std::string, double>;

// Reads a file with a line NAME,SECONDS for each photograph. The number follows the last comma, so
// that names may contain commas. Empty lines, lines that begin with '#', and a first line
// "name,seconds" are skipped. Error that names the file and the line for a line of another form, a
// number that is not finite, and a name that occurs twice; error for a file without a photograph.
PhotographTimes read_photograph_times(const std::filesystem::path& file);

}  // namespace axial::io
