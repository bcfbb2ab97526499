// SPDX-License-Identifier: GPL-3.0-or-later
// The common part of all programs: the options that every OpenMVS program has, the cfg file, the
// log, the exit code.
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>

#include "base/context.h"
#include "base/option_list.h"

namespace axial {

// Values of the options that are common to all programs. parse_options() fills them, and applies
// `log_file`, `process_priority` and `verbosity`. The program itself must apply `max_threads`
// (program_context(), or ThreadLimit in base/parallel.h).
struct CommonOptions {
  std::filesystem::path working_folder;  // absolute; relative paths start here
  std::string config_file;    // as the user gave it; a relative path starts at `working_folder`
  std::string log_file;       // as the user gave it; empty: no log file
  int archive_type = -1;      // the scene format; always -1 (interchange .mvs) after parsing
  int process_priority = -1;  // below 0: the process gets a lower priority; else: no change
  unsigned max_threads = 0;   // 0: as many as cores; at most 1024
  // The lowest log level that is written. 0: warning, 1: info (results of stages), 2: debug
  // (progress), 3: trace (details). Values below 0 count as 0, values above 3 as 3.
  int verbosity = 2;
};

// What parse_options() must know of a program.
struct ProgramOptions {
  std::string name;         // "DensifyPointCloud": log tag and default cfg name
  std::string description;  // one line for --help
  // Options of this program, allowed on the command line and in the cfg file.
  OptionList visible{"Options"};
  OptionList hidden{"Hidden options"};  // like `visible`, but not in --help
  // Text that --help appends to "3 and above: also details". It has the form ", ..." and names the
  // output that this program adds at -v 3 and above.
  std::string when_verbose = "";
  std::string version = "";  // the line that --version prints (base/version.h)
  // The long name of an option with which --input-file may be absent; empty: there is none.
  std::string instead_of_input = "";
};

// The result of parse_options().
struct ParsedOptions {
  CommonOptions common;
  std::set<std::string> given;  // long names of the options on the command line or in the cfg file
  MemoryBudget memory = {};  // of --max-memory; without a limit if the program has no such option
  bool run = false;          // false: the program must do nothing more and exit with exit_code
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
// From now on, errors and the log call the settings of libraries by the options of the program that
// set them: "--mask-path" for setting("mask_folder") (OptionSetting in base/option_list.h).
// The result has `run` = false in three cases:
//   - --version is given: prints the version. The exit code is 0.
//   - -h is given: prints the help. The exit code is 0. (OpenMVS's programs exit with 1 if
//     --input-file is absent, even after -h.)
//   - The program declares --input-file, but the option is absent: prints the help. The exit code
//     is 1.
// Throws an Error for an unknown option, a malformed value, a missing value, a value that breaks a
// rule of the table (base/option_list.h), or an unusable working folder, cfg file or log file.
ParsedOptions parse_options(int argc, const char* const* argv, const ProgramOptions& program);

// The Context of a program: its events go to the log and to the console (base/console.h), and it
// has the limits --max-memory and --max-threads.
Context program_context(const ParsedOptions& parsed);

// True if the user gave the option with the long name `name` on the command line or in the cfg
// file.
bool given(const ParsedOptions& parsed, const std::string& name);

// Returns `path` as an absolute path. A relative `path` starts at the working folder. An empty path
// stays empty.
std::filesystem::path in_working_folder(const CommonOptions& common, const std::string& path);

// Returns in_working_folder() for a file to write, the value of `option` ("--output-file"). Throws
// an Error that names both if `path` ends in a slash, "." or "..", and so has no name for the file.
std::filesystem::path output_in_working_folder(const CommonOptions& common, const std::string& path,
                                               const std::string& option);

// Starts the log ("HH:MM:SS [name] text" on standard output), runs `body` and returns its result,
// the exit code. If `body` throws a std::exception, run_program() writes one line to standard error
// and to the log file, and returns 1. The line is "NAME: out of memory" if memory ran out,
// otherwise "NAME: " and the exception's message (base/message.h).
// A program that links this function also opens closed standard streams when it starts
// (base/standard_streams.h), and reports uncaught exceptions (base/out_of_memory.h). GDAL and PROJ
// use their data beside the program, if there are any (base/bundled_data.h).
int run_program(const std::string& name, const std::function<int()>& body);

}  // namespace axial
