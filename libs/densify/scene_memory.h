// SPDX-License-Identifier: GPL-3.0-or-later
// Checks whether the allowed memory is enough to read a scene and to score its views.
#pragma once

#include "densify/settings.h"
#include "scene/scene.h"

namespace axial::densify {

// Throws an Error if the allowed memory is too little for reading the scene of the settings, with
// the points of Settings::point_cloud, and for scoring its views. The allowed memory is
// memory_limit() (memory_limit.h). The error names max_memory, its value and the least necessary
// value. Call this function before the scene is read: it estimates the memory from the counts of
// images and points in the files. There is no error in two cases:
// - The estimate is at most MemoryAllowance::program_bytes. plan_memory() checks
//   the whole need later.
// - The counts cannot be read. The function that reads the scene reports the fault.
void require_memory_to_read(const Settings& settings);

// Makes the same check for a scene that was read. Call this function before the views are scored.
// The estimate is closer than that of require_memory_to_read(), because it includes the lists of
// neighbours that scoring makes. Throws an Error, too, if a point has a view of an image that does
// not exist.
void require_memory_to_score(const Scene& scene, const Settings& settings);

// The least memory [bytes] with which both checks pass. `scene`: with the neighbours of its images.
std::uint64_t least_memory_to_prepare(const Scene& scene, const Settings& settings);

}  // namespace axial::densify
