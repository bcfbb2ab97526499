// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the error that a parallel loop reports, independently of the number of threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>

namespace axial {

// Runs the items of a parallel loop and keeps the exception of the failed item with the smallest
// number. Once an item has failed, run() skips items with larger numbers, and still runs items with
// smaller numbers. Thread-safe. An object serves one loop.
class FirstError {
 public:
  // Calls body() as the item with the number `item`, or skips it. Throws nothing: an exception of
  // body() is kept for rethrow().
  template <class Body>
  void run(std::size_t item, const Body& body) {
    if (item > failed_) return;
    try {
      body();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (item > failed_) return;
      failed_ = item;
      error_ = std::current_exception();
    }
  }

  // Rethrows the kept exception. Returns if no item has failed. Call this function after the loop.
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::atomic<std::size_t> failed_ = static_cast<std::size_t>(-1);
  std::mutex mutex_;
  std::exception_ptr error_;
};

}  // namespace axial
