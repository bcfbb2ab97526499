// SPDX-License-Identifier: GPL-3.0-or-later Divides the memory that max_memory allows among the
// parts of a run. The plan decides how many images are processed at a time and how much is cached.
// It never affects the result.
#pragma once

#include <cstddef>
#include <cstdint>

#include "densify/project.h"
#include "densify/stage_bytes.h"

namespace axial::densify {

struct MemoryPlan {
  std::size_t in_flight = 1;      // images that are matched at the same time
  std::size_t decodes = 1;        // images that are decoded at the same time at the start
  std::size_t cached_images = 0;  // capacity of the ImageStore
  std::size_t cached_depths = 0;  // StageRun::cached_depths (map_stages.h)
  std::size_t cached_maps = 0;    // StageRun::cached_maps
  std::size_t fused_maps = 0;     // FuseOptions::max_maps
  std::size_t fusion_loads = 1;   // FuseOptions::max_loads
  std::size_t exports = 1;        // images resampled at the same time by the pinhole export
};

// Returns the plan for the result of load_project(). The plan is sufficient for the project's
// largest image and for its longest lists of sources and neighbours. A cache has at most 48
// entries, unless the images in work need more: the memory of a run must not grow with the number
// of images, and more entries would hardly help, because images are processed in order. Throws an
// Error if the allowed memory is too little to process one image at a time, or to write the scene
// while no images are cached. The error names max_memory, its value and the necessary value.
MemoryPlan plan_memory(const Project& project, const Settings& settings);

// The least memory [bytes] of a run that processes `in_flight` images at a time, without the
// scene and without kProgramBytes (memory_limit.h). Its caches hold only the images and maps in
// work.
std::uint64_t least_bytes(const StageBytes& bytes, const ListLengths& lists, std::size_t in_flight);

// Returns the plan for at most `threads` images at a time. `room`: the allowed memory [bytes]
// without the scene and without kProgramBytes. Precondition: `room` is at least least_bytes() for
// one image in flight.
MemoryPlan share_out(const StageBytes& bytes, const ListLengths& lists, std::uint64_t room,
                     std::size_t threads);

}  // namespace axial::densify
