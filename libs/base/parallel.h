// SPDX-License-Identifier: GPL-3.0-or-later
// The one place that knows about threads. Whatever runs here gives the same result for any number
// of threads: work items are independent, and each writes only what belongs to it.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace axial {

// Calls body(i) for every i in [0, count), in any order, on any thread. The first exception thrown
// by a body is rethrown here. `grain`: how many consecutive items a thread takes at once. A thread
// that waits for the others here takes part in this loop only: it does not begin another item of a
// loop around this one, and so does not need that item's memory on top of its own.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body,
                  std::size_t grain = 1);

// The same, begun in the order of i and with at most `in_flight` items (at least 1) at a time: for
// items that need much memory each. Their own loops may be parallel too.
void for_each_in_flight(std::size_t count, std::size_t in_flight,
                        const std::function<void(std::size_t)>& body);

// How many threads parallel work may use now.
std::size_t thread_count();

// Limits all parallel work to `threads` (0: all cores) while it lives.
class ThreadLimit {
 public:
  explicit ThreadLimit(unsigned threads);
  ~ThreadLimit();

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

}  // namespace axial
