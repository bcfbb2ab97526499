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

}  // namespace

ProgressSink console_progress(const std::string& title) {
  const bool terminal = ::isatty(STDOUT_FILENO) != 0;
  return [title, terminal, state = std::make_shared<State>()](std::size_t done, std::size_t total) {
    const auto level = done < total ? LogLevel::debug : LogLevel::info;
    if (!logs(level)) return;
    const auto now = Clock::now();
    const std::chrono::duration<double> since = now - state->shown;
    if (done < total && since.count() < (terminal ? 0.2 : 5.0)) return;
    state->shown = now;
    const double elapsed = std::chrono::duration<double>(now - state->start).count();
    const double left =
        done > 0 ? elapsed / static_cast<double>(done) * static_cast<double>(total - done) : 0.0;
    const double percent =
        total > 0 ? 100.0 * static_cast<double>(done) / static_cast<double>(total) : 100.0;
    const std::string line =
        done < total ? fmt::format("{} {}/{} ({:.0f}%, {:.0f}s, {:.0f}s left)", title, done, total,
                                   percent, elapsed, left)
                     : fmt::format("{} {}/{} (100%, {:.1f}s)", title, done, total, elapsed);
    if (terminal && done < total) {
      fmt::print("\r{}\033[K", line);
      std::fflush(stdout);
    } else {
      log_line(level, line);
    }
  };
}

}  // namespace axial
