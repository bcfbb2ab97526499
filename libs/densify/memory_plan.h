// SPDX-License-Identifier: GPL-3.0-or-later
// Shares out the memory that max_memory allows. The plan affects how much is done at a time and
// how much is cached, but never the result.
#pragma once

#include <cstddef>
#include <cstdint>

#include "densify/project.h"
#include "densify/stage_bytes.h"

namespace axial::densify {

struct MemoryPlan {
  std::size_t in_flight = 1;      // images that are matched at the same time
  std::size_t decodes = 1;        // images that are decoded at the same time at the start
  std::size_t cached_images = 0;  // entries of the ImageStore
  std::size_t cached_depths = 0;  // depths of the previous stage, for geometric consistency
  std::size_t cached_maps = 0;    // whole maps of the previous stage
  std::size_t fused_maps = 0;     // FuseOptions::max_maps
  std::size_t fusion_loads = 1;   // FuseOptions::max_loads
  std::size_t exports = 1;        // images resampled at the same time by the pinhole export
};

// The plan for a project as load_project returns it. It fits the project's largest image and
// longest lists of sources and neighbours. Caches have at most 48 entries: images are processed in
// order, where more entries hardly help, and the memory of a run must not grow with the number of
// images. Error that names max_memory, its value and the necessary value if not even one image at
// a time fits, or if the scene does not fit while it is written (when no images are cached).
MemoryPlan plan_memory(const Project& project, const Settings& settings);

// The memory [bytes] besides the scene of a run that works on `in_flight` images at a time and
// caches nothing more than these need.
std::uint64_t least_bytes(const StageBytes& bytes, const ListLengths& lists, std::size_t in_flight);

// The plan for `room` bytes besides the scene, and for at most `threads` images at a time.
// Precondition: `room` is at least least_bytes() of one image.
MemoryPlan share_out(const StageBytes& bytes, const ListLengths& lists, std::uint64_t room,
                     std::size_t threads);

}  // namespace axial::densify
