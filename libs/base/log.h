// SPDX-License-Identifier: GPL-3.0-or-later
// The program's log. Functions that write lines are thread-safe. Only log.cpp includes the logging
// library, because the library's headers take seconds to compile.
#pragma once

#include <fmt/core.h>

#include <memory>
#include <string>
#include <string_view>

#include "axial/base.h"

namespace axial {

// Sets the lowest level that is written. At the start of the program and after start_log(), it is
// `info`.
void set_log_level(LogLevel level);

// The lowest level that is written.
LogLevel log_level();

// True if lines of `level` are written.
bool logs(LogLevel level);

// Starts the log. From now on lines go to standard output as "HH:MM:SS [name] text", and a warning
// as "HH:MM:SS [name] warning: text". `line_start` is written before each line and must not contain
// '%'. If standard output is a terminal, the caller passes the control characters that erase a line
// of progress, otherwise "". The level becomes `info`, settings have their own names, and lines no
// longer go to an earlier file of log_to_file_too() (log_file.h). Call the other functions after
// start_log().
void start_log(const std::string& name, const std::string& line_start);

// From now on, lines of the log and log_words() call settings by `names`. No other thread may use
// the log at the same time.
void name_settings(SettingNames names);

// Returns in_words(text) with the names of name_settings().
std::string log_words(std::string_view text);

// Writes log_words(line), unless `level` is below the log's level. as_message() (base/message.h)
// makes a warning one line of at most 500 bytes.
void log_line(LogLevel level, std::string_view line);

// Formats one line and writes it by log_line(). The line is formatted only if it is written.
// log_warning(), log_info() and log_details() write `format` with `args` in place of its "{}"
// (fmt's syntax) in this way.
void log_formatted(LogLevel level, fmt::string_view format, fmt::format_args arguments);

// Writes a line of the level `warning`.
template <class... Args>
void log_warning(fmt::format_string<Args...> format, Args&&... args) {
  log_formatted(LogLevel::warning, format, fmt::make_format_args(args...));
}

// Writes a line of the level `info`.
template <class... Args>
void log_info(fmt::format_string<Args...> format, Args&&... args) {
  log_formatted(LogLevel::info, format, fmt::make_format_args(args...));
}

// Writes a line of the level `trace`.
template <class... Args>
void log_details(fmt::format_string<Args...> format, Args&&... args) {
  log_formatted(LogLevel::trace, format, fmt::make_format_args(args...));
}

// For tests. While the object exists, the log collects its lines of the levels `info` and
// `warning`, in which settings have their own names, and writes no line. The destructor restores
// the log. Objects must be destroyed in reverse order.
class LogCapture {
 public:
  LogCapture();
  ~LogCapture();
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;

  // The lines collected so far: the texts alone, without time and name, each with a newline at its
  // end.
  std::string text() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace axial
