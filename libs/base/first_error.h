// SPDX-License-Identifier: GPL-3.0-or-later
// Which of several errors is told, whatever the threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>

namespace axial {

// Runs the items of a parallel loop, and tells the error of the first item that has one, in the
// order of their numbers. Items behind one that failed are left out; those before it are not.
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

  // Call it after the loop.
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::atomic<std::size_t> failed_ = static_cast<std::size_t>(-1);
  std::mutex mutex_;
  std::exception_ptr error_;
};

}  // namespace axial
