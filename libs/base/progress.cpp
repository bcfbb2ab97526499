// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <memory>

#include "base/log.h"

namespace axial {
namespace {

using Clock = std::chrono::steady_clock;

struct State {
  Clock::time_point start = Clock::now();
  Clock::time_point shown;
};

// The first items are slow, because threads and caches start empty, and may finish out of order.
bool can_estimate(std::size_t done, std::size_t total, double elapsed) {
  return done * 20 >= total || (done >= 32 && elapsed >= 10);
}

std::string line_of(const std::string& title, std::size_t done, std::size_t total, double elapsed) {
  if (done == total) return fmt::format("{} {}/{} (100%, {:.1f}s)", title, done, total, elapsed);
  const double percent = 100.0 * static_cast<double>(done) / static_cast<double>(total);
  std::string left;
  if (done > 0 && can_estimate(done, total, elapsed))
    left = fmt::format(", {:.0f}s left",
                       elapsed / static_cast<double>(done) * static_cast<double>(total - done));
  return fmt::format("{} {}/{} ({:.0f}%, {:.0f}s{})", title, done, total, percent, elapsed, left);
}

}  // namespace

ProgressSink console_progress(const std::string& title) {
  const bool terminal = ::isatty(STDOUT_FILENO) != 0;
  return [title, terminal, state = std::make_shared<State>()](std::size_t done, std::size_t total) {
    const auto level = done < total ? LogLevel::debug : LogLevel::info;
    if (!logs(level)) return;
    const auto now = Clock::now();
    const std::chrono::duration<double> since = now - state->shown;
    if (done < total && since.count() < (terminal ? 0.2 : 3.0)) return;
    state->shown = now;
    const double elapsed = std::chrono::duration<double>(now - state->start).count();
    const std::string line = line_of(title, done, total, elapsed);
    if (terminal && done < total) {
      fmt::print("\r{}\033[K", line);
      std::fflush(stdout);
    } else {
      log_line(level, line);
    }
  };
}

}  // namespace axial
