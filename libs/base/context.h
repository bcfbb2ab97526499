// SPDX-License-Identifier: GPL-3.0-or-later
// The caller of a stage gets the events of the stage through a Context, may stop the stage, and
// limits its memory and its threads. A function that warns, reports results or progress, works long
// or needs much memory takes a Context as its last argument. Without a Context, it is silent,
// cannot be stopped and has no limits.
#pragma once

#include <fmt/core.h>

#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "base/log.h"
#include "base/memory_budget.h"
#include "base/parallel.h"
#include "base/progress.h"

namespace axial {

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

// What the work may use.
struct Limits {
  MemoryBudget memory = {};
  // The number of threads of all parallel loops of the process (ThreadLimit in base/parallel.h)
  // while the Context exists. Empty: the Context does not limit them.
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
  std::optional<ThreadLimit> threads_;
  mutable std::mutex mutex_;
};

}  // namespace axial
