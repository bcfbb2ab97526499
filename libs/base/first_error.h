// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the error that a parallel loop reports, independently of the number of threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>

namespace axial {

// Runs the items of a parallel loop and keeps the exception of the failed item with the smallest
// number. After a failure, items with larger numbers than the failed item are skipped, and items
// with smaller numbers are still run. Thread-safe.
class FirstError {
 public:
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

  // Rethrows the kept exception, if there is one. Call this function after the loop.
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::atomic<std::size_t> failed_ = static_cast<std::size_t>(-1);
  std::mutex mutex_;
  std::exception_ptr error_;
};

}  // namespace axial
