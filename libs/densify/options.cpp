// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "axial/densify.h"
#include "base/error.h"
#include "base/program/tiling.h"

namespace axial::densify {
namespace {

// Whether the run only writes points or lists of the scene: no depth maps and no cloud of them.
bool writes_scene_data(const Options& options) {
  return options.job_as<ExportJob>() || options.job_as<NeighbourListsJob>();
}

void check_stage(const StageJob& job, const Options& options) {
  const auto part = [&] { return fmt::format("{} {}/{}", setting("part"), job.part, job.parts); };
  const std::string until = setting("until");
  if (job.parts > 0 && job.until.empty()) fail("{}: needs {}", part(), until);
  if (job.parts > 0 && (job.part < 1 || job.part > job.parts))
    fail("{}: must be from 1/{} to {}/{}", part(), job.parts, job.parts, job.parts);
  if (!options.matching.make_maps) fail("{} {}: this run makes no depth maps", until, job.until);
  if (stages_until(job.until, options.matching) == 0)
    fail("{} {}: must be one of {}, maps", until, job.until,
         fmt::join(stage_names(options.matching), ", "));
}

// Tiles are parts of a fused cloud.
void check_tiles(const Options& options) {
  const FusionOptions& fusion = options.fusion;
  const TileJob* job = options.job_as<TileJob>();
  if (!job && fusion.tiles == 1) return;
  const Tiling tiling{fusion.tiles, job ? std::optional(job->tile) : std::nullopt};
  check(tiling);
  const std::string option = text_of(tiling);
  if (!fusion.fuse || writes_scene_data(options))
    fail("{}: needs fusion, which this run does not make", option);
  const auto refuse = [&](bool given, const std::string& other) {
    if (given) fail("{}: contradicts {}, which needs the whole cloud", option, other);
  };
  refuse(fusion.estimate_colors == 1, setting("estimate_colors 1"));
  refuse(fusion.estimate_normals == 1, setting("estimate_normals 1"));
  refuse(job && !options.output.pinhole_export.empty(), setting("pinhole_export"));
}

}  // namespace

void check(const Options& options) {
  if (options.survey.match_colors && options.survey.color_folder.empty())
    fail("{} needs {}", setting("match_colors"), setting("color_folder"));
  if (const auto* job = options.job_as<StageJob>()) check_stage(*job, options);
  if (const auto* job = options.job_as<PlanJob>(); job && !options.matching.make_maps)
    fail("{} {}: plans only runs that make all depth maps", setting("plan"), job->file.string());
  const bool cloud =
      options.fusion.fuse && (options.job_as<WholeRun>() || options.job_as<TileJob>());
  if (!options.output.pinhole_export.empty() && !cloud)
    fail("{} {}: needs a cloud, which this run does not make", setting("pinhole_export"),
         options.output.pinhole_export.string());
  check_tiles(options);
}

std::vector<std::string> stage_names(const MatchOptions& options) {
  std::vector<std::string> names{"photometric"};
  for (int pass = 0; pass < options.geometric_iterations; ++pass)
    names.push_back(fmt::format("geometric{}", pass + 1));
  if (options.postprocess & kAdjust) names.emplace_back("adjusted");
  return names;
}

std::size_t stages_until(const std::string& until, const MatchOptions& options) {
  const std::vector<std::string> names = stage_names(options);
  if (until == "maps") return names.size();
  const auto found = std::ranges::find(names, until);
  return found == names.end() ? 0 : static_cast<std::size_t>(found - names.begin()) + 1;
}

}  // namespace axial::densify
