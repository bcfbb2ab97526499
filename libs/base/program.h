// SPDX-License-Identifier: GPL-3.0-or-later
// The common part of all programs: the options that every OpenMVS program has, the cfg file, the
// log, the exit code.
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>

#include "base/option_list.h"

namespace axial {

// Values of the options that are common to all programs. parse_options() fills them.
struct CommonOptions {
  std::filesystem::path working_folder;  // absolute; relative paths start here
  std::string config_file;
  std::string log_file;  // empty: no log file
  int archive_type = -1;
  int process_priority = -1;
  unsigned max_threads = 0;
  // The lowest log level that is written. 0: warning, 1: info (results of stages), 2: debug
  // (progress), 3: trace (details).
  int verbosity = 2;
};

struct ProgramOptions {
  std::string name;         // "DensifyPointCloud": log tag and default cfg name
  std::string description;  // one line for --help
  // Options of this program, allowed on the command line and in the cfg file.
  OptionList visible{"Options"};
  OptionList hidden{"Hidden options"};
  // Text that --help appends to "3 and above: also details". It has the form ", ..." and names the
  // output that this program adds at -v 3 and above.
  std::string when_verbose = "";
  std::string version = "";  // the line that --version prints (base/version.h)
};

struct ParsedOptions {
  CommonOptions common;
  std::set<std::string> given;  // full names of the options on the command line or in the cfg
  bool run = false;             // false: there is nothing to do, exit with exit_code
  int exit_code = 0;
};

// Parses the command line and the cfg file, fills the variables of `program` and applies the common
// options (log file, log level, priority). The rules are those of OpenMVS's programs:
//   - Long names may be abbreviated.
//   - A boolean takes a value: 0/1, true/false, yes/no, on/off. A switch may omit its value.
//   - A positional argument is the value of --input-file. A program without this option refuses
//     positional arguments.
//   - The cfg file (default `<name>.cfg` in the working folder) gives values for options that are
//     absent from the command line.
// Prints the version and returns with run = false and exit code 0 after --version. Prints the help
// and returns with run = false in two cases: after -h with exit code 0, and with exit code 1 if the
// program declares --input-file but the option is absent. (Without input OpenMVS exits with 1 in
// both cases.) Throws an Error for an unknown option, a malformed value, a missing value, or an
// unusable working folder or cfg file.
ParsedOptions parse_options(int argc, const char* const* argv, const ProgramOptions& program);

// True if the user gave the option with the full name `name` on the command line or in the cfg
// file.
bool given(const ParsedOptions& parsed, const std::string& name);

// Returns `path` as an absolute path. A relative `path` starts at the working folder. An empty path
// stays empty.
std::filesystem::path in_working_folder(const CommonOptions& common, const std::string& path);

// Starts the log ("HH:MM:SS [name] text" on standard output), runs `body` and returns the result of
// `body`. An exception from `body` becomes one line on standard error (base/message.h), and the
// result is 1. A program that links this function also opens closed standard streams when it starts
// (base/standard_streams.h), and reports uncaught exceptions (base/out_of_memory.h).
int run_program(const std::string& name, const std::function<int()>& body);

}  // namespace axial
