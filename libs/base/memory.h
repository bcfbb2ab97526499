// SPDX-License-Identifier: GPL-3.0-or-later
// The available memory, and the memory that this process uses.
#pragma once

#include <cstdint>
#include <filesystem>

namespace axial {

// An estimate of the bytes that all processes together can still allocate without swapping: the
// system's MemAvailable, or the limit of the container if it is smaller. The limit of the container
// is the lowest limit of this process's control group and of the groups that contain it (cgroup,
// version 1 or 2). What the container already uses is not subtracted from its limit. `root`: the
// folder that contains the folders proc and sys. Tests pass another folder than "/". Throws an
// Error if the system does not report MemAvailable.
std::uint64_t available_memory(const std::filesystem::path& root = "/");

// The bytes of this process that are in memory now (resident set), including its code and its
// libraries. The number differs by some pages from run to run.
std::uint64_t resident_memory();

// The bytes that this process has allocated from the C library and not freed. Large blocks of
// HugePageAllocator are not included, because they come directly from the system. Runs that do the
// same work give the same number.
std::uint64_t allocated_memory();

// From now on all threads share one heap, so that a thread can reuse memory that another thread has
// freed. With a heap per thread, the total size of the heaps would depend on how the work of the
// threads interleaves. Call this function before the first thread starts.
void share_one_heap();

// From now on every block of 1 MiB or more comes directly from the system and is returned to the
// system when it is freed. By default, the C library changes the smallest size of such blocks:
// after it has freed a block that came directly from the system, it takes blocks of up to the size
// of this block from its heaps. Freed blocks then leave holes in the heaps. The size of the holes
// depends on how the work of the threads interleaves.
void map_large_blocks();

// Returns to the system the memory that this process has freed and that the C library keeps for
// reuse, in the heaps of all threads. Call this function at the end of a stage if the next stage
// needs blocks of other sizes.
void return_freed_memory();

}  // namespace axial
