// SPDX-License-Identifier: GPL-3.0-or-later
// How the memory that --max-memory grants is shared out. It decides how much happens at a time and
// what is kept instead of read again, never what the result is.
#pragma once

#include <cstddef>

#include "project.h"

namespace densify {

// Error that names --max-memory, its value and what is needed at least if the scene of
// options.input is too large to be read and its views scored: from its counts, before it is read. A
// scene that takes less than the program itself does is let through, so that plan_memory can say
// all that is needed.
void require_memory_to_read(const Options& options);

// The same for a scene that has been read, with the lists of neighbours, before they are made.
void require_memory_to_score(const axial::Scene& scene, const Options& options);

struct MemoryPlan {
  std::size_t in_flight = 1;      // images that are matched at the same time
  std::size_t decodes = 1;        // images that are decoded at the same time at the start
  std::size_t cached_images = 0;  // in the ImageStore
  std::size_t cached_depths = 0;  // of the stage before, for geometric consistency
  std::size_t cached_maps = 0;    // the same, whole maps
  std::size_t fused_maps = 0;     // FuseOptions::max_maps
  std::size_t fusion_loads = 1;   // FuseOptions::max_loads
  std::size_t exports = 1;        // images resampled at the same time by --pinhole-export
};

// The plan for a project as load_project left it, the largest image and the longest lists of
// sources and neighbours of the project. Caches grow to 48 entries at most: views are taken in the
// order of the images, where more hardly help, and the memory of a run shall not grow with the
// number of images. Error that names
// --max-memory, its value and what is needed if not even one image at a time fits, or the scene
// while it is written (when no images are kept any more).
MemoryPlan plan_memory(const Project& project, const Options& options);

}  // namespace densify
