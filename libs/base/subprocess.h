// SPDX-License-Identifier: GPL-3.0-or-later
// Other programs, run to their end.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace axial {

// Runs `command` (a program, looked up in PATH unless it has a slash, and its arguments) without
// standard input; what it prints becomes `log`. Error that names the program and the log, with the
// last line of it, unless the program ends with exit code 0. It is killed if the calling thread
// ends before it.
void run_subprocess(const std::vector<std::string>& command, const std::filesystem::path& log);

// The same, but false where the program ends with exit code 1 and its log has one of `excuses`: it
// says that there is nothing to find, which may be an answer.
bool run_unless_excused(const std::vector<std::string>& command, const std::filesystem::path& log,
                        const std::vector<std::string>& excuses);

// The folder of the running program: its siblings are there.
std::filesystem::path program_folder();

}  // namespace axial
