// SPDX-License-Identifier: GPL-3.0-or-later
// The common part of all programs: the options that every OpenMVS program has, the cfg file, the
// log, the exit code.
#pragma once

#include <functional>
#include <string>

#include "base/context.h"
#include "base/program/option_list.h"
#include "base/program/parsed_options.h"

namespace axial {

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

// Parses the command line and the cfg file, fills the variables of `program` and applies the common
// options (log file, log level, priority). The rules are those of OpenMVS's programs:
//   - Long names may be abbreviated.
//   - A boolean takes a value: 0/1, true/false, yes/no, on/off. A switch may omit its value.
//   - A positional argument is the value of --input-file. A program without this option refuses
//     positional arguments.
//   - The cfg file (default `<name>.cfg` in the working folder) gives values for options that are
//     absent from the command line.
// From now on, errors and the log call the settings of libraries by the options of the program that
// set them: "--mask-path" for setting("mask_folder") (OptionSetting in base/program/option_list.h).
// The result has `run` = false in three cases:
//   - --version is given: prints the version. The exit code is 0.
//   - -h is given: prints the help. The exit code is 0. (OpenMVS's programs exit with 1 if
//     --input-file is absent, even after -h.)
//   - The program declares --input-file, but the option is absent: prints the help. The exit code
//     is 1.
// Throws an Error for an unknown option, a malformed value, a missing value, a value that breaks a
// rule of the table (base/program/option_list.h), or an unusable working folder, cfg file or log
// file.
ParsedOptions parse_options(int argc, const char* const* argv, const ProgramOptions& program);

// The Context of a program: its events go to the log and to the console (base/program/console.h),
// and it has the limits --max-memory and --max-threads.
Context program_context(const ParsedOptions& parsed);

// Starts the log ("HH:MM:SS [name] text" on standard output), runs `body` and returns its result,
// the exit code. If `body` throws a std::exception, run_program() writes one line to standard error
// and to the log file, and returns 1. The line is "NAME: out of memory" if memory ran out,
// otherwise "NAME: " and the exception's message (base/message.h).
// A program that links this function also opens closed standard streams when it starts
// (base/program/standard_streams.h), and reports uncaught exceptions
// (base/program/out_of_memory.h). GDAL and PROJ use their data beside the program, if there are any
// (base/program/bundled_data.h).
int run_program(const std::string& name, const std::function<int()>& body);

}  // namespace axial
