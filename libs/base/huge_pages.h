// SPDX-License-Identifier: GPL-3.0-or-later
// Memory in pages of 2 MiB, where the system grants them. To match one window in a dozen source
// images, about a hundred image rows are read. With pages of 4 KiB, each of these rows lies in
// another page, and the processor's first-level translation cache (TLB) holds fewer than a hundred.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <new>

namespace axial {

// An allocator for standard containers. All its objects are equal. allocate() throws std::bad_alloc
// if there is no memory.
template <class T>
struct HugePageAllocator {
  using value_type = T;
  static constexpr std::size_t kPage = std::size_t{1} << 21;
  static constexpr std::size_t kSmall = kPage / 4;  // smaller blocks would waste most of a page

  HugePageAllocator() = default;
  template <class U>
  explicit HugePageAllocator(const HugePageAllocator<U>&) {}

  // Returns room for `count` objects, uninitialised. Blocks below kSmall bytes come from the heap,
  // larger blocks directly from the system. Larger blocks begin at a multiple of kPage, and their
  // size is rounded up to a multiple of kPage.
  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    if (bytes < kSmall) return static_cast<T*>(::operator new(bytes));
    return static_cast<T*>(map(rounded(bytes)));
  }

  // Frees a block of allocate(`count`).
  void deallocate(T* block, std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    if (bytes < kSmall)
      ::operator delete(block);
    else
      ::munmap(block, rounded(bytes));
  }

  template <class U>
  bool operator==(const HugePageAllocator<U>&) const {
    return true;
  }

 private:
  static std::size_t rounded(std::size_t bytes) { return (bytes + kPage - 1) / kPage * kPage; }

  // Takes the block from the system and not from the heap, because large blocks leave large holes
  // in the heap when they are freed.
  static void* map(std::size_t bytes) {
    void* room =
        ::mmap(nullptr, bytes + kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (room == MAP_FAILED) throw std::bad_alloc();
    auto* begin = static_cast<std::byte*>(room);
    const std::size_t past = reinterpret_cast<std::uintptr_t>(begin) % kPage;
    const std::size_t before = past > 0 ? kPage - past : 0;
    if (before > 0) ::munmap(begin, before);
    if (before < kPage) ::munmap(begin + before + bytes, kPage - before);
    // If the system does not grant huge pages, the memory has pages of 4 KiB and is slower.
    ::madvise(begin + before, bytes, MADV_HUGEPAGE);
    return begin + before;
  }
};

}  // namespace axial
