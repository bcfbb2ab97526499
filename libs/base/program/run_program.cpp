// SPDX-License-Identifier: GPL-3.0-or-later
// What a program does before main() and around its work. A library that links other functions of
// this folder, such as a module of Python, does not contain this file.
#include <unistd.h>

#include <iostream>
#include <string_view>

#include "base/error.h"
#include "base/log.h"
#include "base/log_file.h"
#include "base/message.h"
#include "base/program/bundled_data.h"
#include "base/program/out_of_memory.h"
#include "base/program/program.h"
#include "base/program/quiet_errors.h"
#include "base/program/standard_streams.h"
#include "base/subprocess.h"

namespace axial {
namespace {

// The loader calls this function before it initialises the libraries, because a library might open
// files or run out of memory.
void prepare_process(int, char**, char**) {
  open_standard_streams();
  report_uncaught_exceptions();
}

[[gnu::section(".preinit_array"),
  gnu::used]] void (*const prepare_process_first)(int, char**, char**) = prepare_process;

// The start of a line of output. On a terminal it erases a line of progress.
std::string line_start(int descriptor) {
  return ::isatty(descriptor) != 0 ? "\r\033[K" : "";
}

void say_error(const std::string& name, std::string_view what) {
  std::cerr << line_start(STDERR_FILENO) << name << ": " << what << "\n";
  log_to_file_only(what);
}

}  // namespace

int run_program(const std::string& name, const std::function<int()>& body) {
  try {
    use_bundled_data(program_folder().parent_path());
    start_log(name, line_start(STDOUT_FILENO));
    filter_errors();
    return body();
  } catch (const std::exception& error) {
    say_error(name, is_out_of_memory(error) ? "out of memory"
                                            : as_message(log_words(marked_text(error))));
  }
  return 1;
}

}  // namespace axial
