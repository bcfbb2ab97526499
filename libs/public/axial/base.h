// SPDX-License-Identifier: GPL-3.0-or-later
// What all stages share: errors, events and progress, stopping, and the memory that a run may use.
//
// The caller of a stage gets the events of the stage through a Context, and may stop the stage. A
// function that warns, reports results or progress, or works long takes a Context as its last
// argument. Without a Context, it is silent and cannot be stopped.
#pragma once

#include <fmt/core.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <string_view>

namespace axial {

// An error that a user can cause. The message names, in this order and as far as they apply, the
// file, the field and the value: "scene.mvs: images[3].poseID is 17, but the platform has 4 poses".
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The names of settings in messages. A library does not know the options of programs. Messages of a
// library call a setting as its headers do, for example "max_memory", unless the caller supplies
// other names.
//
// A function that returns the words by which a message calls `setting`. `setting` is the name of a
// field or of a parameter ("max_memory"), or this name with a value ("make_maps false").
using SettingNames = std::function<std::string(std::string_view setting)>;

// Returns `setting` itself.
inline std::string own_name(std::string_view setting) {
  return std::string(setting);
}

// The levels of lines, in ascending order.
enum class LogLevel { trace, debug, info, warning };

// Receives the progress of a stage: the number of items done and the number of all items. The stage
// calls the sink from one thread at a time. A stage accepts an empty sink and then reports nothing.
using ProgressSink = std::function<void(std::size_t done, std::size_t total)>;

// A line of text, or the progress of a stage.
struct Event {
  enum class Kind { line, progress };
  Kind kind = Kind::line;
  LogLevel level = LogLevel::info;  // of a line
  // The line, or the title of the stage. A warning is one line of at most 500 bytes
  // (base/message.h).
  std::string text;
  // The number of items done and of all items of the stage. Both are 0 when the stage begins.
  std::size_t done = 0, total = 0;
};

using EventSink = std::function<void(const Event&)>;

// Ends a stage whose stop was requested. Its files are those of a run that was killed: the same run
// continues from them.
class Stopped : public std::exception {
 public:
  const char* what() const noexcept override { return "stopped"; }
};

class Context {
 public:
  Context() = default;
  // `sink` gets all events, from one thread at a time. It may be empty. After a request to stop by
  // the source of `stop`, check_stop() and the sinks of stage() throw Stopped.
  explicit Context(EventSink sink, std::stop_token stop = {});

  // Each sends a line: `format` with `args` in place of its "{}" (fmt's syntax).
  template <class... Args>
  void warning(fmt::format_string<Args...> format, Args&&... args) const {
    send(LogLevel::warning, format, fmt::make_format_args(args...));
  }
  template <class... Args>
  void info(fmt::format_string<Args...> format, Args&&... args) const {
    send(LogLevel::info, format, fmt::make_format_args(args...));
  }
  template <class... Args>
  void details(fmt::format_string<Args...> format, Args&&... args) const {
    send(LogLevel::trace, format, fmt::make_format_args(args...));
  }

  // A sink for the Context of a part of the work: its lines and titles begin with `prefix`. This
  // Context must exist as long as the sink.
  EventSink with_prefix(std::string prefix) const;

  // Begins a stage, and returns the sink for its progress. The Context must exist as long as the
  // sink.
  ProgressSink stage(const std::string& title) const;

  const std::stop_token& stop_token() const { return stop_; }
  bool stop_requested() const { return stop_.stop_requested(); }
  // Throws Stopped after a request to stop.
  void check_stop() const;

 private:
  void send(LogLevel level, fmt::string_view format, fmt::format_args arguments) const;
  void send(const Event& event) const;

  EventSink sink_;
  std::stop_token stop_;
  mutable std::mutex mutex_;
};

inline constexpr std::uint64_t kMegabyte = 1'000'000;  // the unit of options in megabytes [bytes]

// The memory that a program may use, to check before each piece of work.
struct MemoryAllowance {
  // The limit. 0: 70 % of the memory that is available or used by this process, at the time of a
  // call.
  std::uint64_t megabytes = 0;
  std::string setting;              // the name of `megabytes` in messages
  std::uint64_t program_bytes = 0;  // of code and libraries, stacks and small blocks [bytes]

  // Throws an Error if the program would exceed the limit with `bytes` more bytes than it uses now.
  // The use is resident_memory(), but at least program_bytes, so that a program that has just begun
  // decides like one that has loaded all of its code. The message is one line. It begins with
  // `setting` and tells how many megabytes the program needs for `work`.
  void require(std::uint64_t bytes, const std::string& work) const;

  // The bytes between the use, as in require(), and the limit. 0 if the use is at the limit.
  std::uint64_t left() const;
};

}  // namespace axial
