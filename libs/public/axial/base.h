// SPDX-License-Identifier: GPL-3.0-or-later
// What all stages share: errors, events and progress, stopping, and the memory and the threads that
// a run may use.
//
// The caller of a stage gets the events of the stage through a Context, may stop the stage, and
// limits its memory and its threads. A function that warns, reports results or progress, works long
// or needs much memory takes a Context as its last argument. Without a Context, it is silent,
// cannot be stopped and has no limits.
#pragma once

#include <fmt/core.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <string_view>

namespace axial {

// A setting in the text of an error or of a line: `name` between two marks. `name` is the name of a
// field or of a parameter ("max_memory"), or this name with a value ("make_maps false"). A library
// does not know the options of programs. Its messages mark the settings, and in_words() puts other
// names in their place.
std::string setting(std::string_view name);

// The words by which messages call settings, such as the options of a program: from names of
// setting() to words.
using SettingNames = std::map<std::string, std::string, std::less<>>;

// Returns `text` without marks: each setting has the name in `names`, or its own name if `names`
// lacks the setting.
std::string in_words(std::string_view text, const SettingNames& names = {});

// An error that a user can cause. The message names, in this order and as far as they apply, the
// file, the field and the value: "scene.mvs: images[3].poseID is 17, but the platform has 4 poses".
// what() is one line of at most 500 bytes, in which settings have their own names.
class Error : public std::runtime_error {
 public:
  // `text`: the message, which may contain setting(). `file`: the result of file().
  explicit Error(const std::string& text, const std::filesystem::path& file = {});

  // The message with its marks, for in_words() and for the text of another Error.
  const std::string& text() const;
  // The file, or the place in a file ("a.txt: line 3"), with which the message begins. Empty: the
  // message begins otherwise.
  const std::filesystem::path& file() const;
  // The name of the setting with which the message begins ("max_memory"). Empty: there is none.
  std::string setting() const;

 private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

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
  // (base/message.h). Settings have their own names.
  std::string text;
  // The number of items done and of all items of the stage. Both are 0 when the stage begins.
  std::size_t done = 0, total = 0;
  std::string marked{};  // of a line: the text with its marks, for in_words(), of any length
};

using EventSink = std::function<void(const Event&)>;

// Ends a stage whose stop was requested. Its files are those of a run that was killed: the same run
// continues from them.
class Stopped : public std::exception {
 public:
  const char* what() const noexcept override { return "stopped"; }
};

inline constexpr std::uint64_t kMegabyte = 1'000'000;  // the unit of options in megabytes [bytes]

// The bytes of code and libraries, stacks and small blocks of a program.
inline constexpr std::uint64_t kProgramBytes = 96 * kMegabyte;

// The memory that work may use. The budget travels in the Context. Copies of a budget have a common
// count of reservations. All functions may be called from several threads at the same time.
class MemoryBudget {
  struct State;

 public:
  // Bytes of a budget that are in use as long as this object exists.
  class Reservation {
   public:
    Reservation() = default;  // of no bytes
    Reservation(std::shared_ptr<State> state, std::uint64_t bytes);
    Reservation(Reservation&& other) noexcept;
    Reservation& operator=(Reservation&& other) noexcept;
    ~Reservation();

   private:
    std::shared_ptr<State> state_;
    std::uint64_t bytes_ = 0;
  };

  // Without a limit.
  MemoryBudget() = default;

  // The budget of a whole program: `megabytes` megabytes, or, for 0, 70 % of the memory that is now
  // available or used by this process. What the process uses at the time of a call is in use, at
  // least `program_bytes`, so that a program that has just begun decides like one that has loaded
  // all of its code. Messages call `megabytes` the setting "max_memory". Throws an Error that names
  // the setting for 0 megabytes if the system does not report how much memory is available.
  static MemoryBudget of_program(std::uint64_t megabytes,
                                 std::uint64_t program_bytes = kProgramBytes);

  // A budget of `bytes` bytes. Only reservations are in use, so that decisions do not depend on
  // what the process uses.
  static MemoryBudget of_bytes(std::uint64_t bytes);

  // The budget of a stage that counts its own memory: of_bytes(left()) for the budget of a program;
  // another budget itself.
  MemoryBudget share() const;

  // The same budget, with errors of require() that end with `advice`.
  MemoryBudget with_advice(std::string advice) const;

  bool is_limited() const { return state_ != nullptr; }

  // The next three are for a budget that has a limit.
  std::uint64_t megabytes() const;      // of_program(): as given, also 0
  std::uint64_t program_bytes() const;  // of_bytes(): 0
  std::uint64_t limit() const;          // [bytes]

  // The bytes between the use and the limit. 0 if the use is at the limit; the largest number if
  // there is no limit.
  std::uint64_t left() const;

  // Throws an Error if `bytes` are more than left(). The message is one line. It begins with the
  // setting. For the budget of a program, it tells how many megabytes the program needs for `work`;
  // otherwise, how many more megabytes `work` needs.
  void require(std::uint64_t bytes, const std::string& work) const;

  // How many items of `each` bytes, at least 1 and at most `most`, can be in memory at the same
  // time. Throws the Error of require() if there is no room for one.
  std::size_t items(std::uint64_t each, std::size_t most, const std::string& work) const;

  // Takes `bytes` of what is left, even if less is left.
  [[nodiscard]] Reservation reserve(std::uint64_t bytes) const;
  // The same after require().
  [[nodiscard]] Reservation reserve(std::uint64_t bytes, const std::string& work) const;

 private:
  std::shared_ptr<State> state_;  // null: no limit
  std::string advice_;
};

class ThreadLimit;  // of the library

// What the work may use.
struct Limits {
  MemoryBudget memory = {};
  // The number of threads of all parallel loops of the process while the Context exists; 0: as
  // many as cores. Empty: the Context does not limit them.
  std::optional<unsigned> threads = {};
};

class Context {
 public:
  Context() = default;
  // `sink` gets all events, from one thread at a time. It may be empty. After a request to stop by
  // the source of `stop`, check_stop() and the sinks of stage() throw Stopped.
  explicit Context(EventSink sink, std::stop_token stop = {}, const Limits& limits = {});
  // For a part of the work of `whole`, which must exist as long as this Context.
  Context(const Context& whole, MemoryBudget memory);

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

  const MemoryBudget& memory() const { return memory_; }

  const std::stop_token& stop_token() const { return stop_; }
  bool stop_requested() const { return stop_.stop_requested(); }
  // Throws Stopped after a request to stop.
  void check_stop() const;

 private:
  void send(LogLevel level, fmt::string_view format, fmt::format_args arguments) const;
  void send(const Event& event) const;

  EventSink sink_;
  std::stop_token stop_;
  MemoryBudget memory_;
  std::shared_ptr<const ThreadLimit> threads_;
  mutable std::mutex mutex_;
};

}  // namespace axial
