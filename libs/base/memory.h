// SPDX-License-Identifier: GPL-3.0-or-later
// How much memory there is, and how much of it this process holds.
#pragma once

#include <cstdint>
#include <filesystem>

namespace axial {

// Bytes that can be taken without swapping: what the system calls available, or the limit of the
// container (cgroup, version 1 or 2) if that is lower. `root`: where /proc and /sys lie. Error if
// the system does not say.
std::uint64_t available_memory(const std::filesystem::path& root = "/");

// Bytes of this process that are in memory now, its programs and libraries included. Differs by
// some pages from run to run.
std::uint64_t resident_memory();

// Bytes that this process has allocated from the C library and not freed (huge_pages.h asks the
// system itself): the same in every run that did the same.
std::uint64_t allocated_memory();

// All threads take their blocks from one heap from now on, so that what one has freed serves the
// next. Else each keeps a heap of its own, and how much they hold together depends on how the
// threads' work happens to interleave. To be called before there are threads.
void share_one_heap();

// From now on every block of a megabyte or more comes straight from the system and goes back there
// when freed. The C library would keep such blocks in its heaps as soon as one was freed, with
// holes between them whose size depends on how the threads' work happens to interleave.
void map_large_blocks();

// Gives back to the system what this process has freed and the C library keeps for later, in every
// thread its own. For the end of a stage, whose successor needs blocks of other sizes.
void return_freed_memory();

}  // namespace axial
