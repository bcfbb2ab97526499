// SPDX-License-Identifier: GPL-3.0-or-later
// The progress of a stage. A stage reports its progress to a sink. The program chooses the sink.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <utility>

#include "axial/base.h"

namespace axial {

// Returns a sink that writes "<title> 3/10 (30%, 12s, 28s left)": the items done, the time since
// this function was called, and an estimate of the time left. The estimate begins after 5 % of the
// items, or after 32 items and 10 seconds. On a terminal the sink overwrites one line. Otherwise it
// logs a line every 3 seconds at most. At the end of the stage (done = total) it logs the line
// "<title> 10/10 (100%, 40.0s)". Progress has the log level debug, and the end of the stage has the
// level info. The sink writes nothing at a level that the log does not write.
ProgressSink console_progress(const std::string& title);

// Counts the items that several threads finish, and calls a sink from one thread at a time.
class ProgressCounter {
 public:
  // `total`: the number of all items. `sink` may be empty.
  ProgressCounter(ProgressSink sink, std::size_t total) : sink_(std::move(sink)), total_(total) {}

  // Adds one finished item. Thread-safe.
  void add() {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (sink_) sink_(done_, total_);
  }

 private:
  ProgressSink sink_;
  std::size_t total_, done_ = 0;
  std::mutex mutex_;
};

}  // namespace axial
