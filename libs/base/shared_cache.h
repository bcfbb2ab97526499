// SPDX-License-Identifier: GPL-3.0-or-later
// Values that are made when asked for and kept as long as there is room.
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

// Keeps `capacity` values, the most recently asked for. Those that somebody holds are not dropped,
// because that would free nothing: with more of them in use there are as many as are in use.
// Thread-safe: a value that several threads want at the same time is made once, and the others wait
// for it. An exception out of `make` reaches all who wait; the next one to ask tries again.
template <class Value>
class SharedCache {
 public:
  using Make = std::function<Value(std::size_t key)>;
  using Pointer = std::shared_ptr<const Value>;

  SharedCache(Make make, std::size_t capacity) : make_(std::move(make)), capacity_(capacity) {}

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

  // What is there for `key`, or nothing: then the caller has entered its promise for it.
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
  std::list<Entry> recent_;  // the most recent first
};

}  // namespace axial
