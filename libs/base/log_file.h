// SPDX-License-Identifier: GPL-3.0-or-later
// A file that the log's lines go to, besides standard output (--log-file).
#pragma once

#include <filesystem>
#include <string_view>

namespace axial {

// From now on the log's lines also go to the end of `file`, which is made if it is not there, with
// their dates. Error that names it if it cannot be written, or if it is not empty and does not begin
// with such a line: it is no log then, but a scene or a photograph.
void log_to_file_too(const std::filesystem::path& file);

// A line for that file alone; nothing without one.
void log_to_file_only(std::string_view line);

}  // namespace axial
