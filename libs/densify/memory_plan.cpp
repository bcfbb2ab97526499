// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/memory_plan.h"

#include <algorithm>

#include "base/error.h"
#include "base/huge_pages.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "densify/agreement_check.h"
#include "densify/cloud_exports.h"
#include "densify/pinhole_export.h"
#include "depth/filters.h"
#include "depth/plane_map.h"
#include "io/mvs_counts.h"
#include "io/point_source.h"

namespace axial::densify {
namespace {

constexpr std::size_t kMostCached = 48;
constexpr std::uint64_t kMegabyte = 1000 * 1000;

// The program with its libraries, stacks, small blocks, and the portions of fusion.
constexpr std::uint64_t kOnTop = 96 * kMegabyte;

std::uint64_t cap_of(const Settings& settings) {
  return settings.max_memory > 0 ? settings.max_memory * kMegabyte : available_memory() / 10 * 7;
}

// The memory that a project holds for each image besides the scene: view, chosen neighbours,
// fingerprint.
std::uint64_t kept_of_images(std::uint64_t images) {
  constexpr std::uint64_t kChosen = 1024;
  return images * (sizeof(View) + kChosen);
}

// The memory for the text of the housing and of the lenses while it is read.
std::uint64_t side_files(const Settings& settings) {
  constexpr std::uint64_t kPerByte = 12;
  std::uint64_t bytes = 0;
  for (const std::filesystem::path& file :
       {housing_file(settings), io::lenses_beside(settings.input)}) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (!error) bytes += size;
  }
  return kPerByte * bytes;
}

// The memory of a scene before its views are scored.
std::uint64_t kept_of(const io::MvsCounts& counts, const Settings& settings) {
  return counts.scene_bytes() + side_files(settings) + kept_of_images(counts.images);
}

// `bytes`: the peak while the scene is read and its views are scored.
void require_memory_for_scene(std::uint64_t bytes, const Settings& settings) {
  const std::uint64_t cap = cap_of(settings), least = bytes + kOnTop;
  if (bytes > kOnTop && cap < least)
    fail(
        "--max-memory {}: {} MB are too little, this scene needs at least {} MB for reading and "
        "for scoring its views",
        settings.max_memory, cap / kMegabyte, least / kMegabyte + 1);
}

// Memory [bytes] of the large data, for the largest image.
struct Sizes {
  std::uint64_t scene;
  std::uint64_t write_scene;  // besides `scene`, while it is written
  std::uint64_t decode;       // while an image is read: its file, its pixels, the result
  std::uint64_t image;        // WorkImage
  std::uint64_t map;          // DepthMap: depth, normal, confidence
  std::uint64_t depths;       // of a DepthMap, the depths alone
  std::uint64_t read_map;     // while a map is read or written: the file's bytes, converted depths
  std::uint64_t match;        // matching, with the results
  std::uint64_t adjust;
  std::uint64_t fused;     // FusionMap
  std::uint64_t taken;     // fusion's bits of all views
  std::uint64_t exported;  // while an image is resampled, without cached images
};

// The lengths of the longest lists, each including the image itself.
struct Counts {
  std::size_t images = 0, references = 0;
  std::size_t matched = 0, adjusted = 0, fused = 0;
};

Counts count(const Project& project, const Settings& settings) {
  Counts counts;
  counts.images = project.scene.images.size();
  counts.references = project.references.size();
  for (const std::size_t image : project.references) {
    counts.matched = std::max(counts.matched, 1 + project.sources[image].size());
    counts.fused = std::max(counts.fused, 1 + project.neighbours[image].size());
  }
  counts.fused = std::min(counts.fused, counts.references);
  if (settings.postprocess & kAdjust)
    counts.adjusted = std::min(counts.fused, 1 + depth::AdjustOptions().max_neighbours);
  return counts;
}

Sizes measure(const Project& project, const Settings& settings, const Counts& counts) {
  std::uint64_t pixels = 0, decode = 0;
  bool masks = false;
  Sizes sizes{};
  for (const View& view : project.views) {
    if (!settings.pinhole_export.empty())
      sizes.exported = std::max(sizes.exported, bytes_to_resample(view));
    const auto area = [](std::int64_t width, std::int64_t height) {
      return static_cast<std::uint64_t>(width * height);
    };
    pixels = std::max(pixels, area(view.camera.width, view.camera.height));
    decode = std::max(decode,
                      view.file.decode_bytes * area(view.file.size.width, view.file.size.height));
    masks |= view.masked();
  }
  const std::uint64_t sources = counts.matched - 1;
  const std::uint64_t colors = needs_colors(settings) ? 3 : 0;
  sizes.scene = allocated_memory();
  sizes.write_scene = io::count_scene(project.scene).writing_bytes();
  sizes.decode = decode + 4 * pixels;
  sizes.image = (1 + (masks ? 1 : 0) + colors) * pixels;
  sizes.map = 20 * pixels;
  sizes.depths = 4 * pixels;
  sizes.read_map = 44 * pixels;
  // Planes of this level and the previous one, priors, the result and its filtered copies. For each
  // source: its pixels twice as words of 2 x 2 neighbours, and its depths.
  constexpr std::uint64_t kPlane = sizeof(depth::PlanePixel);
  sizes.match = (kPlane + kPlane / 4 + 8 + 60) * pixels +
                sources * (12 * pixels + 2 * HugePageAllocator<int>::kPage);
  // Rays and the result; for each neighbour its surface on the pixels of the map.
  if (counts.adjusted > 0) sizes.adjust = (24 + 20 + (counts.adjusted - 1) * 12) * pixels;
  sizes.fused = (20 + colors) * pixels;
  sizes.taken = counts.references * pixels / 8;
  return sizes;
}

std::uint64_t matching(const Sizes& sizes, const Counts& counts, std::size_t in_flight) {
  const std::uint64_t images = counts.matched * sizes.image;
  const std::uint64_t maps =
      std::max(sizes.map + (counts.matched - 1) * sizes.depths, counts.adjusted * sizes.map);
  const std::uint64_t work = std::max({sizes.match, sizes.adjust, sizes.decode});
  return in_flight * (images + maps + work + sizes.read_map);
}

std::uint64_t fusing(const Sizes& sizes, std::size_t maps, std::size_t loads) {
  return sizes.taken + maps * sizes.fused + loads * (sizes.decode + sizes.read_map + sizes.map);
}

// The memory of a run that works on `in_flight` images at a time and caches nothing. The image
// store lives longer than matching.
std::uint64_t least_for(const Sizes& sizes, const Counts& counts, std::size_t in_flight) {
  return std::max({matching(sizes, counts, in_flight), sizes.write_scene, sizes.exported,
                   in_flight * counts.matched * sizes.image + fusing(sizes, counts.fused, 1)});
}

// The largest number up to `wanted` whose `need` is within `bytes`, but at least one.
template <class Need>
std::size_t most(std::size_t wanted, std::uint64_t bytes, const Need& need) {
  while (wanted > 1 && need(wanted) > bytes) --wanted;
  return std::max<std::size_t>(wanted, 1);
}

// `entries`, and as many more as `spare` bytes allow, but not more than kMostCached.
std::size_t enlarged(std::size_t entries, std::uint64_t each, std::uint64_t spare) {
  const std::size_t wanted = kMostCached - std::min(entries, kMostCached);
  return entries + std::min<std::size_t>(wanted, spare / each);
}

MemoryPlan share_out(const Sizes& sizes, const Counts& counts, std::uint64_t room) {
  MemoryPlan plan;
  const std::size_t threads = thread_count();
  plan.in_flight = most(std::min(threads, counts.references), room,
                        [&](std::size_t k) { return least_for(sizes, counts, k); });
  const std::size_t images = counts.matched * plan.in_flight;
  const std::uint64_t spare = room - least_for(sizes, counts, plan.in_flight);
  plan.cached_images = enlarged(images, sizes.image, spare / 2);
  const std::uint64_t kept = plan.cached_images * sizes.image;
  plan.decodes =
      most(threads, room - kept, [&](std::size_t k) { return k * (sizes.decode + sizes.image); });

  const std::uint64_t more_images = (plan.cached_images - images) * sizes.image;
  // The stages that cache depths and the stages that cache whole maps run one after the other.
  // Comparing maps (agreement_check.h) takes less memory than matching.
  const std::uint64_t for_maps = room - matching(sizes, counts, plan.in_flight) - more_images;
  plan.cached_depths = enlarged((counts.matched - 1) * plan.in_flight, sizes.depths, for_maps);
  plan.cached_maps =
      enlarged(std::max(counts.adjusted, kMapsCompared) * plan.in_flight, sizes.map, for_maps);

  const auto fuse = [&](std::size_t loads) { return fusing(sizes, counts.fused, loads); };
  plan.fusion_loads = most(std::min(threads, counts.fused), room - kept, fuse);
  plan.exports = most(threads, room, [&](std::size_t k) { return k * sizes.exported; });
  plan.fused_maps = enlarged(counts.fused, sizes.fused, room - kept - fuse(plan.fusion_loads));
  return plan;
}

}  // namespace

void require_memory_to_read(const Settings& settings) {
  auto counts = io::count_mvs(settings.input);
  if (!counts) return;
  std::uint64_t reading = counts->reading_bytes();
  if (!settings.point_cloud.empty())
    if (const auto cloud = io::count_point_cloud(settings.point_cloud, *counts)) {
      reading = std::max(reading, cloud->reading_bytes);
      if (!only_exports(settings)) counts = cloud->scene;
    }
  const ScoringMemory scoring =
      scoring_memory({counts->images, counts->points, counts->observations, 0});
  const std::uint64_t kept = kept_of(*counts, settings);
  require_memory_for_scene(
      std::max({reading, kept + scoring.work + scoring.kept, kept + counts->writing_bytes()}),
      settings);
}

void require_memory_to_score(const Scene& scene, const Settings& settings) {
  ScoringSize size = scoring_size(scene, settings.selection);
  const io::MvsCounts counts = io::count_scene(scene);
  const auto needed = [&] {
    const ScoringMemory scoring = scoring_memory(size);
    io::MvsCounts written = counts;
    written.set_view_scores(size.neighbours);
    return kept_of(counts, settings) + scoring.kept +
           std::max(scoring.work, written.writing_bytes());
  };
  if (needed() + kOnTop > cap_of(settings))
    size.neighbours = count_neighbours(scene, settings.selection);
  require_memory_for_scene(needed(), settings);
}

MemoryPlan plan_memory(const Project& project, const Settings& settings) {
  const Counts counts = count(project, settings);
  const Sizes sizes = measure(project, settings, counts);
  const std::uint64_t cap = cap_of(settings);
  const std::uint64_t fixed = sizes.scene + kOnTop;
  const std::uint64_t least = fixed + least_for(sizes, counts, 1);
  if (cap < least)
    fail("--max-memory {}: {} MB are too little, this scene needs {} MB", settings.max_memory,
         cap / kMegabyte, least / kMegabyte + 1);
  const MemoryPlan plan = share_out(sizes, counts, cap - fixed);
  log_details(
      "Memory {} MB, at least {}: {} images at a time, {} kept, {} depths, {} maps, {} in fusion",
      cap / kMegabyte, least / kMegabyte + 1, plan.in_flight, plan.cached_images,
      plan.cached_depths, plan.cached_maps, plan.fused_maps);
  return plan;
}

}  // namespace axial::densify
