// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/memory_plan.h"

#include <algorithm>
#include <optional>

#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "cloud/fuse.h"
#include "densify/pinhole_export.h"
#include "densify/pinhole_model.h"
#include "densify/tiles.h"
#include "depth/filters.h"
#include "depth/patch_match.h"
#include "io/images/image.h"
#include "io/openmvs/dmap.h"
#include "io/openmvs/mvs_counts.h"
#include "io/openmvs/point_source.h"
#include "survey/image_store.h"

namespace axial::densify {
namespace {

// The memory that a project holds for each image besides the scene: view, chosen neighbours,
// fingerprint.
std::uint64_t kept_of_images(std::uint64_t images) {
  constexpr std::uint64_t kChosen = 1024;
  return images * (sizeof(View) + kChosen);
}

// The memory for the text of the housing and of the lenses while it is read.
std::uint64_t side_files(const io::SceneFiles& files) {
  constexpr std::uint64_t kPerByte = 12;
  std::uint64_t bytes = 0;
  for (const std::filesystem::path& file :
       {io::housing_file(files), io::lenses_beside(files.scene)}) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (!error) bytes += size;
  }
  return kPerByte * bytes;
}

// The memory of a scene before its views are scored.
std::uint64_t kept_of(const io::MvsCounts& counts, const io::SceneFiles& files) {
  return counts.scene_bytes() + side_files(files) + kept_of_images(counts.images);
}

// The peak while the file of the scene is read and before its views are scored. Empty if the file
// cannot be counted.
std::optional<std::uint64_t> bytes_to_read(const io::SceneFiles& files,
                                           const std::filesystem::path& point_cloud,
                                           bool for_export) {
  auto counts = io::count_mvs(files.scene);
  if (!counts) return {};
  std::uint64_t reading = counts->reading_bytes();
  if (!point_cloud.empty())
    if (const auto cloud = io::count_point_cloud(point_cloud, *counts)) {
      reading = std::max(reading, cloud->reading_bytes);
      if (!for_export) counts = cloud->scene;
    }
  const ScoringMemory scoring =
      scoring_memory({counts->images, counts->points, counts->observations, 0});
  const std::uint64_t kept = kept_of(*counts, files);
  return std::max({reading, kept + scoring.work + scoring.kept, kept + counts->writing_bytes()});
}

// The peak while views are scored, with `size.neighbours` neighbours.
std::uint64_t bytes_to_score(const io::MvsCounts& counts, const ScoringSize& size,
                             const io::SceneFiles& files) {
  const ScoringMemory scoring = scoring_memory(size);
  io::MvsCounts written = counts;
  written.set_view_scores(size.neighbours);
  return kept_of(counts, files) + scoring.kept + std::max(scoring.work, written.writing_bytes());
}

// `bytes`: the peak while the scene is read and its views are scored.
void require_memory_for_scene(std::uint64_t bytes, const MemoryBudget& memory) {
  const std::uint64_t limit = memory.limit(), least = bytes + memory.program_bytes();
  if (bytes > memory.program_bytes() && limit < least)
    fail(
        "{} {}: {} MB are too little, this scene needs at least {} MB for reading and for "
        "scoring its views",
        setting("max_memory"), memory.megabytes(), limit / kMegabyte, least / kMegabyte + 1);
}

constexpr std::size_t kMostCached = 48;

// While `in_flight` images are matched or adjusted. The image store lives longer than matching.
std::uint64_t matching(const StageBytes& bytes, const ListLengths& lists, std::size_t in_flight) {
  const std::uint64_t images = lists.matched * bytes.image;
  const std::uint64_t maps =
      std::max(bytes.map + (lists.matched - 1) * bytes.depths, lists.adjusted * bytes.map);
  const std::uint64_t work = std::max({bytes.match, bytes.adjust, bytes.decode});
  return in_flight * (images + maps + work + bytes.read_map);
}

std::uint64_t fusing(const StageBytes& bytes, std::size_t maps, std::size_t loads) {
  return bytes.taken + maps * bytes.fused + loads * (bytes.decode + bytes.read_map + bytes.map);
}

// The largest number up to `wanted` whose `need` is within `room`, but at least one.
template <class Need>
std::size_t most(std::size_t wanted, std::uint64_t room, const Need& need) {
  while (wanted > 1 && need(wanted) > room) --wanted;
  return std::max<std::size_t>(wanted, 1);
}

// `entries`, and as many more as `spare` bytes allow, but not more than kMostCached.
std::size_t enlarged(std::size_t entries, std::uint64_t each, std::uint64_t spare) {
  const std::size_t wanted = kMostCached - std::min(entries, kMostCached);
  return entries + std::min<std::size_t>(wanted, spare / each);
}

}  // namespace

void require_memory_to_read(const survey::Options& survey, const std::filesystem::path& point_cloud,
                            bool for_export, const MemoryBudget& memory) {
  if (const auto bytes = bytes_to_read(survey.files, point_cloud, for_export))
    require_memory_for_scene(*bytes, memory);
}

void require_memory_to_score(const Scene& scene, const survey::Options& survey,
                             const ViewSelectionOptions& selection, const MemoryBudget& memory) {
  ScoringSize size = scoring_size(scene, selection);
  const io::MvsCounts counts = io::count_scene(scene);
  if (bytes_to_score(counts, size, survey.files) + memory.program_bytes() > memory.limit())
    size.neighbours = count_neighbours(scene, selection);
  require_memory_for_scene(bytes_to_score(counts, size, survey.files), memory);
}

std::uint64_t least_memory_to_prepare(const Scene& scene, const survey::Options& survey,
                                      const ViewOptions& options) {
  ScoringSize size = scoring_size(scene, options.selection);
  size.neighbours = 0;
  for (const SceneImage& image : scene.images) size.neighbours += image.neighbours.size();
  io::MvsCounts counts = io::count_scene(scene);
  counts.set_view_scores(0);  // before scoring
  const std::uint64_t reading = bytes_to_read(survey.files, options.point_cloud, false).value_or(0);
  return std::max(bytes_to_score(counts, size, survey.files), reading);
}

ListLengths longest_lists(const Project& project, const MatchOptions& matching,
                          const FusionOptions& fusion) {
  ListLengths lists;
  lists.references = project.references.size();
  for (const std::size_t image : project.references) {
    lists.matched = std::max(lists.matched, 1 + project.sources[image].size());
    lists.fused = std::max(lists.fused, 1 + project.neighbours[image].size());
  }
  lists.fused = std::min(lists.fused, lists.references);
  lists.marked =
      fusion.fuse && fusion.tiles > 1 ? most_views_of_a_tile(project, fusion) : lists.references;
  if (matching.postprocess & kAdjust)
    lists.adjusted = std::min(lists.fused, 1 + depth::AdjustOptions().max_neighbours);
  return lists;
}

StageBytes bytes_of_stages(const Project& project, const Options& options,
                           const ListLengths& lists) {
  const bool colors = options.fusion.needs_colors();
  const bool exports = !options.output.pinhole_export.empty();
  std::uint64_t pixels = 0, decode = 0;
  bool masks = false;
  StageBytes bytes;
  for (const View& view : project.views) {
    if (exports) bytes.exported = std::max(bytes.exported, bytes_needed_to_resample(view));
    pixels = std::max(pixels, view.pixels());
    decode = std::max(decode, view.decoding_bytes());
    masks |= view.masked();
  }
  bytes.scene = allocated_memory();
  bytes.write_scene = io::count_scene(project.scene).writing_bytes();
  if (exports) {
    bytes.shown = bytes_of_pinhole_points(project.scene);
    bytes.model = bytes_needed_for_pinhole_model(project.scene);
  }
  bytes.decode = survey::bytes_needed_to_load(decode, pixels);
  bytes.image = survey::bytes_needed(survey::PixelsSize{pixels, masks, colors});
  bytes.map = bytes_of_map(pixels);
  bytes.depths = bytes_of_depths(pixels);
  bytes.read_map = io::dmap_bytes_needed(pixels);
  bytes.match = depth::bytes_needed(depth::MatchSize{pixels, lists.matched - 1});
  if (lists.adjusted > 0)
    bytes.adjust = depth::bytes_needed(depth::AdjustSize{pixels, lists.adjusted - 1});
  bytes.fused = cloud::bytes_needed({.pixels = pixels, .maps = 1, .colors = colors});
  bytes.taken = cloud::bytes_needed({.pixels = pixels, .views = lists.marked});
  return bytes;
}

std::uint64_t least_bytes(const StageBytes& bytes, const ListLengths& lists,
                          std::size_t in_flight) {
  const std::uint64_t exporting = bytes.shown + std::max(bytes.exported, bytes.model);
  return std::max({matching(bytes, lists, in_flight), bytes.write_scene, exporting,
                   in_flight * lists.matched * bytes.image + fusing(bytes, lists.fused, 1)});
}

MemoryPlan share_out(const StageBytes& bytes, const ListLengths& lists, std::uint64_t room,
                     std::size_t threads) {
  MemoryPlan plan;
  plan.in_flight = most(std::min(threads, lists.references), room,
                        [&](std::size_t k) { return least_bytes(bytes, lists, k); });
  const std::size_t images = lists.matched * plan.in_flight;
  const std::uint64_t spare = room - least_bytes(bytes, lists, plan.in_flight);
  plan.cached_images = enlarged(images, bytes.image, spare / 2);
  const std::uint64_t kept = plan.cached_images * bytes.image;
  plan.decodes =
      most(threads, room - kept, [&](std::size_t k) { return k * (bytes.decode + bytes.image); });

  const std::uint64_t more_images = (plan.cached_images - images) * bytes.image;
  // The stages that cache depths and the stages that cache whole maps run one after the other.
  // Comparing maps takes less memory than matching.
  const std::uint64_t for_maps = room - matching(bytes, lists, plan.in_flight) - more_images;
  plan.cached_depths = enlarged((lists.matched - 1) * plan.in_flight, bytes.depths, for_maps);
  plan.cached_maps =
      enlarged(std::max(lists.adjusted, kMapsCompared) * plan.in_flight, bytes.map, for_maps);

  const auto fuse = [&](std::size_t loads) { return fusing(bytes, lists.fused, loads); };
  plan.fusion_loads = most(std::min(threads, lists.fused), room - kept, fuse);
  plan.least_fused_maps = lists.fused;
  plan.marked_views = lists.marked;
  plan.exports =
      most(threads, room - bytes.shown, [&](std::size_t k) { return k * bytes.exported; });
  plan.fused_maps = enlarged(lists.fused, bytes.fused, room - kept - fuse(plan.fusion_loads));
  return plan;
}

MemoryPlan plan_memory(const Project& project, const Options& options, const Context& context) {
  const MemoryBudget& memory = context.memory();
  const ListLengths lists = longest_lists(project, options.matching, options.fusion);
  const StageBytes bytes = bytes_of_stages(project, options, lists);
  const std::uint64_t limit = memory.limit();
  const std::uint64_t fixed = bytes.scene + memory.program_bytes();
  const std::uint64_t least = fixed + least_bytes(bytes, lists, 1);
  if (limit < least)
    fail("{} {}: {} MB are too little, this scene needs {} MB", setting("max_memory"),
         memory.megabytes(), limit / kMegabyte, least / kMegabyte + 1);
  const MemoryPlan plan = share_out(bytes, lists, limit - fixed, thread_count());
  context.details(
      "Memory {} MB, at least {}: {} images at a time, {} kept, {} depths, {} maps, {} in fusion",
      limit / kMegabyte, least / kMegabyte + 1, plan.in_flight, plan.cached_images,
      plan.cached_depths, plan.cached_maps, plan.fused_maps);
  return plan;
}

}  // namespace axial::densify
