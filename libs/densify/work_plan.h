// SPDX-License-Identifier: GPL-3.0-or-later
// The work of a run and of its parts, for programs that share a run among the nodes of a cluster.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "densify/project.h"

namespace axial::densify {

// The work of one job: a part of a stage, or the fusion.
struct JobWork {
  double cpu_seconds = 0;        // estimate, on one core of 2024 (Zen 5, 4 GHz)
  std::uint64_t max_memory = 0;  // [MB]: the least Settings::max_memory that keeps all threads busy
  // [MB]: the memory that the job can use with this setting. A scheduler should allow it.
  std::uint64_t memory = 0;
};

// The work of a run.
struct WorkPlan {
  std::size_t images = 0;           // number of images that get depth maps
  std::size_t parts = 0;            // number of parts of each stage
  unsigned threads = 1;             // of each job
  std::vector<std::string> stages;  // names, in their order
  std::vector<JobWork> per_part;    // of a part of each stage; the largest part
  JobWork fusion;
};

// Estimates the work of a run with the present number of threads (base/parallel.h). The number of
// parts is Settings::planned_parts, or, if that is 0, the number for which a part of the longest
// stage takes about ten minutes with all threads. There are at most as many parts as images.
// `project`: the result of load_project() with Settings::parts 0.
WorkPlan plan_work(const Project& project, const Settings& settings);

// Writes plan_work() to `file` as JSON: the members "images", "parts", "threads", "stages",
// "per_part" and "fusion". "per_part" has a member for each stage. This member and "fusion" have
// the members "cpu_seconds", "max_memory_mb" and "memory_mb". Throws an Error if the file cannot be
// written.
void write_work_plan(const std::filesystem::path& file, const Project& project,
                     const Settings& settings);

}  // namespace axial::densify
