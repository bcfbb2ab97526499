// SPDX-License-Identifier: GPL-3.0-or-later
// Runs other programs and waits for their end.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace axial {

// Runs `command`: a program, which is searched in PATH unless its name has a slash, and its
// arguments. Standard input is empty; standard output and error go to the file `log`. If the
// program does not end with exit code 0, throws an Error with its name, the name of the log and the
// last line of the log. Also throws an Error if the program cannot be started. The program is
// killed if the calling thread ends first.
void run_subprocess(const std::vector<std::string>& command, const std::filesystem::path& log);

// The same, but returns false if the program ends with exit code 1 and its log contains one of
// `excuses`. An excuse is a text by which the program says that it found nothing, which the caller
// does not treat as an error. Returns true if the exit code is 0.
bool run_unless_excused(const std::vector<std::string>& command, const std::filesystem::path& log,
                        const std::vector<std::string>& excuses);

// The folder of the running program. The other programs of the project are in the same folder.
std::filesystem::path program_folder();

}  // namespace axial
