// SPDX-License-Identifier: GPL-3.0-or-later
// A cache of values that are made on demand.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <future>
#include <list>
#include <memory>
#include <mutex>

namespace axial {

// Keeps the `capacity` most recently requested values (at least one). A value that is in use
// outside the cache is not evicted, because its eviction would free no memory. The cache can
// therefore exceed `capacity`. Thread-safe: if several threads request a value at the same time,
// one thread makes the value and the others wait. An exception from `make` reaches all waiting
// threads. The next request calls `make` again.
template <class Value>
class SharedCache {
 public:
  using Make = std::function<Value(std::size_t key)>;
  using Pointer = std::shared_ptr<const Value>;

  SharedCache(Make make, std::size_t capacity) : make_(std::move(make)), capacity_(capacity) {}

  // The value of `key`, never null. Calls make(key) if the value is not in the cache. make(key) may
  // request other keys, but not `key` itself.
  Pointer get(std::size_t key) {
    std::promise<Pointer> promise;
    if (const auto made = enter(key, promise); made.valid()) return made.get();
    try {
      auto value = std::make_shared<const Value>(make_(key));
      promise.set_value(value);
      return value;
    } catch (...) {
      forget(key);
      promise.set_exception(std::current_exception());
      throw;
    }
  }

 private:
  struct Entry {
    std::size_t key;
    std::shared_future<Pointer> value;
  };

  auto find(std::size_t key) {
    return std::find_if(recent_.begin(), recent_.end(),
                        [&](const Entry& entry) { return entry.key == key; });
  }

  // The future of the value of `key`. If there was no entry for `key`, the future is invalid: then
  // this function has entered `promise` for `key`, and the caller must fulfil the promise.
  std::shared_future<Pointer> enter(std::size_t key, std::promise<Pointer>& promise) {
    const std::lock_guard lock(mutex_);
    if (const auto found = find(key); found != recent_.end()) {
      recent_.splice(recent_.begin(), recent_, found);
      return found->value;
    }
    make_room();
    recent_.push_front({key, promise.get_future().share()});
    return {};
  }

  void forget(std::size_t key) {
    const std::lock_guard lock(mutex_);
    recent_.erase(find(key));
  }

  static bool idle(const Entry& entry) {
    const bool made = entry.value.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    return made && entry.value.get().use_count() == 1;
  }

  void make_room() {
    for (auto it = recent_.end(); recent_.size() >= capacity_ && it != recent_.begin();)
      if (idle(*--it)) it = recent_.erase(it);
  }

  Make make_;
  std::size_t capacity_;
  std::mutex mutex_;
  std::list<Entry> recent_;  // the most recently requested first
};

}  // namespace axial
