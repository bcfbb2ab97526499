// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

namespace axial {

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body,
                  std::size_t grain) {
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, count, grain),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
      },
      tbb::simple_partitioner());
}

// Built where it stays: a copy of a global_control compiles, but limits nothing.
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
