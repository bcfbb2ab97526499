// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/context.h"

#include <fmt/format.h>

#include <utility>

#include "base/message.h"
#include "base/parallel.h"

namespace axial {

Context::Context(EventSink sink, std::stop_token stop, const Limits& limits)
    : sink_(std::move(sink)), stop_(std::move(stop)), memory_(limits.memory) {
  if (limits.threads) threads_ = std::make_shared<const ThreadLimit>(*limits.threads);
}

Context::Context(const Context& whole, MemoryBudget memory)
    : sink_(whole.with_prefix("")), stop_(whole.stop_), memory_(std::move(memory)) {}

EventSink Context::with_prefix(std::string prefix) const {
  return [this, prefix = std::move(prefix)](Event event) {
    event.text = prefix + event.text;
    if (event.kind == Event::Kind::line) event.marked = prefix + event.marked;
    send(event);
  };
}

ProgressSink Context::stage(const std::string& title) const {
  check_stop();
  send({Event::Kind::progress, LogLevel::info, title});
  return [this, title](std::size_t done, std::size_t total) {
    check_stop();
    send({Event::Kind::progress, LogLevel::info, title, done, total});
  };
}

void Context::check_stop() const {
  if (stop_requested()) throw Stopped();
}

void Context::send(LogLevel level, fmt::string_view format, fmt::format_args arguments) const {
  if (!sink_) return;
  const std::string marked = fmt::vformat(format, arguments), line = in_words(marked);
  send({Event::Kind::line, level, level == LogLevel::warning ? as_message(line) : line, 0, 0,
        marked});
}

void Context::send(const Event& event) const {
  if (!sink_) return;
  const std::lock_guard lock(mutex_);
  sink_(event);
}

}  // namespace axial
