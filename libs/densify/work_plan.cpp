// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/work_plan.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/log.h"
#include "base/parallel.h"
#include "densify/depth_stage.h"
#include "densify/memory_limit.h"
#include "densify/memory_plan.h"
#include "densify/scene_memory.h"
#include "densify/stage_bytes.h"
#include "io/bytes/json.h"

namespace axial::densify {
namespace {

// CPU seconds for a million pixels of a map, for each source view or neighbour: rounded from the
// progress lines of clouds of 10 and 12 photographs of 1024 x 768 pixels.
constexpr double kMatchSeconds = 0.2;  // with two sweeps per level
constexpr double kGeometricSeconds = 0.1;
constexpr double kAdjustSeconds = 0.05;
constexpr double kFuseSeconds = 0.03;
constexpr double kSecondsOfPart = 600;

// The number of pairs of a pixel and another image, in millions. `others`: the images that are
// compared with the pixels of each image, by image.
double million_pairs(const Project& project, const std::vector<std::vector<ViewScore>>& others) {
  double sum = 0;
  for (const std::size_t image : project.references)
    sum += 1e-6 * project.views[image].camera.width * project.views[image].camera.height *
           static_cast<double>(others[image].size());
  return sum;
}

std::vector<double> seconds_of_stages(const Project& project, const Settings& settings) {
  const double pairs = million_pairs(project, project.sources);
  const double sweeps = settings.matching.iterations / 2.0;
  std::vector<double> seconds{pairs * kMatchSeconds * sweeps};
  for (int pass = 0; pass < settings.geometric_iterations; ++pass)
    seconds.push_back(pairs * kGeometricSeconds);
  if (settings.postprocess & kAdjust)
    seconds.push_back(million_pairs(project, project.neighbours) * kAdjustSeconds);
  return seconds;
}

std::size_t number_of_parts(const Settings& settings, std::size_t images, double longest) {
  auto parts = static_cast<double>(settings.planned_parts);
  if (settings.planned_parts == 0)
    parts = std::ceil(longest / (kSecondsOfPart * static_cast<double>(thread_count())));
  return static_cast<std::size_t>(std::clamp(parts, 1.0, static_cast<double>(images)));
}

JobWork job(double cpu_seconds, std::uint64_t bytes) {
  const std::uint64_t megabytes = bytes / kMegabyte + 1;
  // A run may exceed its limit by a tenth.
  return {cpu_seconds, megabytes, megabytes + megabytes / 10};
}

nlohmann::json written(const JobWork& work) {
  return {{"cpu_seconds", std::ceil(work.cpu_seconds)},
          {"max_memory_mb", work.max_memory},
          {"memory_mb", work.memory}};
}

}  // namespace

WorkPlan plan_work(const Project& project, const Settings& settings) {
  const ListLengths lists = longest_lists(project, settings);
  const StageBytes bytes = bytes_of_stages(project, settings, lists);
  const std::vector<double> seconds = seconds_of_stages(project, settings);
  WorkPlan plan;
  plan.images = project.references.size();
  plan.threads = static_cast<unsigned>(thread_count());
  plan.stages = stage_names(settings);
  plan.parts = number_of_parts(settings, plan.images, *std::ranges::max_element(seconds));
  // With less memory, fewer images than threads would be processed at the same time.
  const std::uint64_t memory = std::max(
      bytes.scene + settings.survey.memory.program_bytes + least_bytes(bytes, lists, plan.threads),
      least_memory_to_prepare(project.scene, settings));
  const double share =
      std::ceil(static_cast<double>(plan.images) / static_cast<double>(plan.parts)) /
      static_cast<double>(plan.images);
  for (const double all : seconds) plan.per_part.push_back(job(all * share, memory));
  plan.fusion = job(million_pairs(project, project.neighbours) * kFuseSeconds, memory);
  return plan;
}

void write_work_plan(const std::filesystem::path& file, const Project& project,
                     const Settings& settings) {
  const WorkPlan plan = plan_work(project, settings);
  nlohmann::json parts = nlohmann::json::object();
  for (std::size_t i = 0; i < plan.stages.size(); ++i)
    parts[plan.stages[i]] = written(plan.per_part[i]);
  io::write_json(file, {{"images", plan.images},
                        {"parts", plan.parts},
                        {"threads", plan.threads},
                        {"stages", plan.stages},
                        {"per_part", parts},
                        {"fusion", written(plan.fusion)}});
  log_info("{}: {} images in {} parts", file.string(), plan.images, plan.parts);
}

}  // namespace axial::densify
