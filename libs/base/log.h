// SPDX-License-Identifier: GPL-3.0-or-later
// The program's log. Only log.cpp includes the logging library, because the library's headers take
// seconds to compile.
#pragma once

#include <fmt/core.h>

#include <memory>
#include <string>
#include <string_view>

namespace axial {

enum class LogLevel { trace, debug, info, warning };

// Sets the lowest level that is written. The default is `info`.
void set_log_level(LogLevel level);

// The lowest level that is written.
LogLevel log_level();

// True if lines of `level` are written.
bool logs(LogLevel level);

// Starts the log. Lines go to standard output as "HH:MM:SS [name] text". `line_start` is written
// before each line: on a terminal, the control characters that erase a line of progress.
void start_log(const std::string& name, const std::string& line_start);

// Writes one line, unless `level` is below the log's level.
void log_line(LogLevel level, std::string_view line);

// Formats one line and writes it, unless `level` is below the log's level. The line is formatted
// only if it is written. A warning is shortened by as_message() (base/message.h).
void log_formatted(LogLevel level, fmt::string_view format, fmt::format_args arguments);

template <class... Args>
void log_warning(fmt::format_string<Args...> format, Args&&... args) {
  log_formatted(LogLevel::warning, format, fmt::make_format_args(args...));
}

template <class... Args>
void log_info(fmt::format_string<Args...> format, Args&&... args) {
  log_formatted(LogLevel::info, format, fmt::make_format_args(args...));
}

template <class... Args>
void log_details(fmt::format_string<Args...> format, Args&&... args) {
  log_formatted(LogLevel::trace, format, fmt::make_format_args(args...));
}

// While the object exists, collects the log's lines of `info` and above instead of writing them.
// For tests.
class LogCapture {
 public:
  LogCapture();
  ~LogCapture();
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;

  // The lines collected so far, each with a newline at its end.
  std::string text() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace axial
