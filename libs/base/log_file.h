// SPDX-License-Identifier: GPL-3.0-or-later
// A file for the log, in addition to standard output.
#pragma once

#include <filesystem>
#include <string_view>

namespace axial {

// From now on the log's lines are also appended to `file`, with date and time. Call this function
// after start_log() (base/log.h). Creates `file` if it does not exist. Throws an Error that names
// `file` in two cases: `file` cannot be written, or it has content that does not begin with a date
// and time. A file with such content is not a log, but perhaps a scene or a photograph that the
// user named by mistake.
void log_to_file_too(const std::filesystem::path& file);

// Writes a line, with date and time, to the file of log_to_file_too(), but not to standard output.
// The line is written whatever level set_log_level() of base/log.h has set. Does nothing if
// log_to_file_too() was not called.
void log_to_file_only(std::string_view line);

}  // namespace axial
