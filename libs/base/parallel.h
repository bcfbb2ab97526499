// SPDX-License-Identifier: GPL-3.0-or-later
// Parallel loops. No other part of the project starts threads. The result of a loop must not depend
// on the number of threads: the items of a loop must be independent, and each item may write only
// its own data.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace axial {

// Calls body(i) for every i in [0, count), in any order, on any thread. Returns when all calls have
// returned. If calls throw, one of the exceptions is rethrown to the caller after the calls that
// have begun have returned, and items that have not begun may be left out. Which exception is
// rethrown can differ from run to run; FirstError (base/first_error.h) avoids this. `grain`: the
// largest number of consecutive items that a thread takes at once, at least 1. If loops are nested,
// a thread that waits for the end of the inner loop does not begin another item of the outer loop.
// So no thread holds the memory of two items of the outer loop.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body,
                  std::size_t grain = 1);

// The `grain` of a loop whose items are short, for example the work on one point or one pixel.
inline constexpr std::size_t kPointGrain = 1024;

// Calls body(i) for every i in [0, count), on any thread, and returns when all calls have returned.
// If a call throws, the exception is rethrown to the caller after the calls that have begun have
// returned, and items that have not begun may be left out. This loop is for items that need much
// memory. The items begin in the order of i. No more than `in_flight` items run at the same time.
// An `in_flight` of 0 counts as 1. The items may use parallel loops themselves.
void for_each_in_flight(std::size_t count, std::size_t in_flight,
                        const std::function<void(std::size_t)>& body);

// The largest number of threads that parallel loops use now, including the calling thread.
std::size_t thread_count();

// Limits all parallel loops of the process to `threads` threads while the object exists. 0: as many
// threads as the process may use cores. If several objects exist, the lowest limit holds.
class ThreadLimit {
 public:
  explicit ThreadLimit(unsigned threads);
  ~ThreadLimit();

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

}  // namespace axial
