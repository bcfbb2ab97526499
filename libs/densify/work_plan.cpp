// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/work_plan.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "densify/memory_plan.h"
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

std::vector<double> seconds_of_stages(const Project& project, const MatchOptions& options) {
  const double pairs = million_pairs(project, project.sources);
  const double sweeps = options.iterations / 2.0;
  std::vector<double> seconds{pairs * kMatchSeconds * sweeps};
  for (int pass = 0; pass < options.geometric_iterations; ++pass)
    seconds.push_back(pairs * kGeometricSeconds);
  if (options.postprocess & kAdjust)
    seconds.push_back(million_pairs(project, project.neighbours) * kAdjustSeconds);
  return seconds;
}

std::size_t number_of_parts(std::size_t asked, std::size_t images, double longest) {
  auto parts = static_cast<double>(asked);
  if (asked == 0)
    parts = std::ceil(longest / (kSecondsOfPart * static_cast<double>(thread_count())));
  return static_cast<std::size_t>(std::clamp(parts, 1.0, static_cast<double>(images)));
}

nlohmann::json work(double cpu_seconds, std::uint64_t bytes) {
  const std::uint64_t megabytes = bytes / kMegabyte + 1;
  // A run may exceed its limit by a tenth.
  return {{"cpu_seconds", std::ceil(cpu_seconds)},
          {"max_memory_mb", megabytes},
          {"memory_mb", megabytes + megabytes / 10}};
}

// The least memory with which as many images as threads are processed at the same time.
std::uint64_t memory_of(const Project& project, const Options& options,
                        std::uint64_t program_bytes) {
  const ListLengths lists = longest_lists(project, options.matching, options.fusion);
  const StageBytes bytes = bytes_of_stages(project, options, lists);
  return program_bytes +
         std::max(bytes.scene + least_bytes(bytes, lists, thread_count()),
                  least_memory_to_prepare(project.scene, options.survey, options.views));
}

}  // namespace

void write_work_plan(const Project& project, const Options& options, const PlanJob& job,
                     const Context& context) {
  const std::uint64_t memory = memory_of(project, options, context.memory().program_bytes());
  const std::vector<double> seconds = seconds_of_stages(project, options.matching);
  const std::vector<std::string> names = stage_names(options.matching);
  const std::size_t images = project.references.size();
  const std::size_t parts = number_of_parts(job.parts, images, *std::ranges::max_element(seconds));
  const auto all = static_cast<double>(images);
  const double share = std::ceil(all / static_cast<double>(parts)) / all;
  nlohmann::json per_part = nlohmann::json::object();
  for (std::size_t i = 0; i < names.size(); ++i)
    per_part[names[i]] = work(seconds[i] * share, memory);
  const double fusion = million_pairs(project, project.neighbours) * kFuseSeconds;
  io::write_json(job.file, {{"images", images},
                            {"parts", parts},
                            {"threads", thread_count()},
                            {"stages", names},
                            {"per_part", per_part},
                            {"fusion", work(fusion, memory)}});
  context.info("{}: {} images in {} parts", job.file.string(), images, parts);
}

}  // namespace axial::densify
