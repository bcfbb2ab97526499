// SPDX-License-Identifier: GPL-3.0-or-later
// The options that a user gave to a program.
#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "axial/base.h"

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

// The result of parse_options().
struct ParsedOptions {
  CommonOptions common;
  std::set<std::string> given;  // long names of the options on the command line or in the cfg file
  MemoryBudget memory = {};  // of --max-memory; without a limit if the program has no such option
  bool run = false;          // false: the program must do nothing more and exit with exit_code
  int exit_code = 0;
};

// True if the user gave the option with the long name `name` on the command line or in the cfg
// file.
bool given(const ParsedOptions& parsed, const std::string& name);

// Returns `path` as an absolute path. A relative `path` starts at the working folder. An empty path
// stays empty.
std::filesystem::path in_working_folder(const CommonOptions& common, const std::string& path);

}  // namespace axial
