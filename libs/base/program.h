// SPDX-License-Identifier: GPL-3.0-or-later
// What all programs share: the options every OpenMVS program has, the cfg file, the log, the exit
// code.
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>

#include "base/option_list.h"

namespace axial {

// Options common to all programs, filled by `parse_options`.
struct CommonOptions {
  std::filesystem::path working_folder;  // absolute; base of every relative path
  std::string config_file;
  std::string log_file;  // empty: none
  int archive_type = -1;
  int process_priority = -1;
  unsigned max_threads = 0;
  // 0: warnings, 1: stages (the log's info), 2: progress (debug), 3: details (trace).
  int verbosity = 2;
};

struct ProgramOptions {
  std::string name;         // "DensifyPointCloud": log tag and default cfg name
  std::string description;  // one line for --help
  // Options of this program, allowed on the command line and in the cfg file.
  OptionList visible{"Options"};
  OptionList hidden{"Hidden options"};
  std::string when_verbose = "";  // ", ...": what -v 3 and above give besides, for --help
};

// Parses the command line the way OpenMVS's programs do: long names may be abbreviated, booleans
// take a value (0/1, true/false, yes/no, on/off), which a switch may go without, positional
// arguments are `--input-file`, and refused by a program that has none. The cfg
// file (default `<name>.cfg` in the working folder) gives values for options absent from the
// command line. Prints the help and returns false if there is nothing to run: exit with 0 after
// `-h`, and with 1 when `--input-file` is declared by the program but absent (OpenMVS exits with 1
// in both cases when there is no input; scripts see the difference only after asking for help).
// Throws Error for an unknown option, a malformed value, an unusable working folder.
struct ParsedOptions {
  CommonOptions common;
  std::set<std::string> given;  // full names of the options on the command line or in the cfg
  bool run = false;
  int exit_code = 0;
};
ParsedOptions parse_options(int argc, const char* const* argv, const ProgramOptions& program);

// True if the user gave the option of this full name, on the command line or in the cfg.
bool given(const ParsedOptions& parsed, const std::string& name);

// `path` relative to the working folder unless absolute; empty stays empty.
std::filesystem::path in_working_folder(const CommonOptions& common, const std::string& path);

// Sets up the log ("HH:MM:SS [App] text" on standard output), runs `body`, and turns any exception
// into one line on standard error (base/message.h) and exit code 1. A program that calls it has
// standard streams from its start (base/standard_streams.h), and an exception that nothing catches
// is such a line, too (base/out_of_memory.h).
int run_program(const std::string& name, const std::function<int()>& body);

}  // namespace axial
