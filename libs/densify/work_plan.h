// SPDX-License-Identifier: GPL-3.0-or-later
// The work of a run and of its parts, for programs that share a run among the nodes of a cluster.
#pragma once

#include "densify/project.h"

namespace axial::densify {

// Estimates the work of a run with the present number of threads (base/parallel.h) and writes it to
// the file of the job as JSON, with the members
// - "images": the number of images that get depth maps,
// - "parts": the number of parts of each stage: PlanJob::parts, or, if that is 0, the number for
//   which a part of the longest stage takes about ten minutes with all threads; at most as many as
//   images,
// - "threads": of each job,
// - "stages": their names, in their order,
// - "per_part": the work of the largest part of each stage, by its name, and "fusion". A work has
//   the members "cpu_seconds" (estimate, on one core of 2024: Zen 5, 4 GHz), "max_memory_mb" (the
//   least max_memory that keeps all threads busy), and "memory_mb" (the memory that the job can use
//   with this setting: a scheduler should allow it).
// Throws an Error if the file cannot be written.
void write_work_plan(const Project& project, const Options& options, const PlanJob& job,
                     const Context& context);

}  // namespace axial::densify
