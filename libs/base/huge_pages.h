// SPDX-License-Identifier: GPL-3.0-or-later
// Memory in pages of 2 MiB, where the system grants them: a matching window in a dozen source
// images touches a hundred rows, each in another page of 4 KiB, more than the processor's first
// page table cache holds.
#pragma once

#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace axial {

template <class T>
struct HugePageAllocator {
  using value_type = T;
  static constexpr std::size_t kPage = std::size_t{1} << 21;
  static constexpr std::size_t kSmall = kPage / 4;  // below, a page of its own would be a waste

  HugePageAllocator() = default;
  template <class U>
  explicit HugePageAllocator(const HugePageAllocator<U>&) {}

  // Small blocks come from where all others do.
  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    if (bytes < kSmall) return static_cast<T*>(::operator new(bytes));
    const std::size_t pages = (bytes + kPage - 1) / kPage * kPage;
    void* block = std::aligned_alloc(kPage, pages);
    if (!block) throw std::bad_alloc();
    // A refusal costs speed and nothing else.
    ::madvise(block, pages, MADV_HUGEPAGE);
    return static_cast<T*>(block);
  }

  void deallocate(T* block, std::size_t count) {
    if (count * sizeof(T) < kSmall)
      ::operator delete(block);
    else
      std::free(block);
  }

  template <class U>
  bool operator==(const HugePageAllocator<U>&) const {
    return true;
  }
};

}  // namespace axial
