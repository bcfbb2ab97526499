// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace axial {

namespace {

// If an item of a loop throws, oneTBB ends the loop early. By default it also ends all loops inside
// the other items of this loop, without an exception: these items would go on with half of their
// results. A loop with a context of its own goes to its end.
constexpr auto kOwn = tbb::task_group_context::isolated;

}  // namespace

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body,
                  std::size_t grain) {
  tbb::task_group_context context(kOwn);
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, grain),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
        },
        tbb::simple_partitioner(), context);
  });
}

void for_each_in_flight(std::size_t count, std::size_t in_flight,
                        const std::function<void(std::size_t)>& body) {
  tbb::task_group_context context(kOwn);
  std::size_t next = 0;
  const auto begin_next = [&](tbb::flow_control& control) {
    if (next == count) control.stop();
    return next++;
  };
  tbb::parallel_pipeline(
      std::max<std::size_t>(in_flight, 1),
      tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, begin_next) &
          tbb::make_filter<std::size_t, void>(tbb::filter_mode::parallel, body),
      context);
}

std::size_t thread_count() {
  return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

// Holds the global_control without copying it: a copy of a global_control compiles, but limits
// nothing.
struct ThreadLimit::Control {
  explicit Control(std::size_t threads)
      : control(tbb::global_control::max_allowed_parallelism, threads) {}
  Control(const Control&) = delete;
  Control& operator=(const Control&) = delete;

  tbb::global_control control;
};

ThreadLimit::ThreadLimit(unsigned threads) {
  const auto limit =
      threads > 0 ? threads : static_cast<unsigned>(tbb::info::default_concurrency());
  control_ = std::make_unique<Control>(limit);
}

ThreadLimit::~ThreadLimit() = default;

}  // namespace axial
