// SPDX-License-Identifier: GPL-3.0-or-later
// Runs other programs and waits for their end.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace axial {

// Runs a program and waits for its end. `command`: the program, followed by its arguments. A
// program whose name has no slash is searched in PATH. Standard input is empty. Standard output and
// standard error go to the file `log`, which is overwritten. Throws an Error if the program cannot
// be started. If the program does not end with exit code 0, throws an Error that contains the name
// of the program, the exit code or signal, the name of the log and the last line of the log. The
// program is killed if the calling thread ends first.
void run_subprocess(const std::vector<std::string>& command, const std::filesystem::path& log);

// Runs a program like run_subprocess(), except that an excused failure is not an error. A failure
// is excused if the program ends with exit code 1 and its log contains one of the texts `excuses`.
// An excuse is a text by which a program says that it found nothing. Returns true for exit code 0,
// and false for an excused failure.
bool run_unless_excused(const std::vector<std::string>& command, const std::filesystem::path& log,
                        const std::vector<std::string>& excuses);

// The absolute path of the folder of the running program. The other programs of the project are in
// the same folder.
std::filesystem::path program_folder();

}  // namespace axial
