// SPDX-License-Identifier: GPL-3.0-or-later
// Divides the memory that max_memory allows among the parts of a run. The plan decides how many
// images are processed at a time and how much is cached. It never affects the result.
#pragma once

#include <cstddef>
#include <cstdint>

#include "densify/project.h"
#include "densify/stage_bytes.h"

namespace axial::densify {

// How many images and maps a run may have in memory at the same time.
struct MemoryPlan {
  std::size_t in_flight = 1;      // images that are matched or adjusted at the same time
  std::size_t decodes = 1;        // images that ImageStore::check_all() reads at the same time
  std::size_t cached_images = 0;  // capacity of the ImageStore
  std::size_t cached_depths = 0;  // StageRun::cached_depths (map_stages.h)
  std::size_t cached_maps = 0;    // StageRun::cached_maps
  std::size_t fused_maps = 0;     // FuseOptions::max_maps
  // The least value of fused_maps that suffices for any view and its neighbours.
  std::size_t least_fused_maps = 0;
  std::size_t marked_views = 0;  // views of which fusion can mark each pixel (ListLengths::marked)
  std::size_t fusion_loads = 1;  // FuseOptions::max_loads
  std::size_t exports = 1;       // images resampled at the same time by the pinhole export
};

// Returns the plan for the result of load_project() and for the present number of threads
// (base/parallel.h). The plan is sufficient for the project's largest image and for its longest
// lists of sources and neighbours. A cache has at most 48 entries, unless the images in work need
// more: the memory of a run must not grow with the number of images, and more entries would hardly
// help, because images are processed in order.
// Throws an Error if the allowed memory (memory_limit()) is too little to process one image at a
// time, or to write the scene while no images are cached. The error names max_memory, its value,
// the allowed memory and the necessary memory.
MemoryPlan plan_memory(const Project& project, const Settings& settings);

// The least memory [bytes] of a run that processes `in_flight` images at a time, without the loaded
// scene (StageBytes::scene) and without MemoryAllowance::program_bytes. Its caches hold only the
// images and maps in work.
std::uint64_t least_bytes(const StageBytes& bytes, const ListLengths& lists, std::size_t in_flight);

// Returns the plan for at most `threads` images at a time. `room`: the allowed memory [bytes]
// without the loaded scene (StageBytes::scene) and without MemoryAllowance::program_bytes.
// Precondition: `room` is at least least_bytes() for one image in flight.
MemoryPlan share_out(const StageBytes& bytes, const ListLengths& lists, std::uint64_t room,
                     std::size_t threads);

}  // namespace axial::densify
