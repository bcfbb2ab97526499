// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/memory_plan.h"

#include <algorithm>

#include "base/error.h"
#include "base/log.h"
#include "base/parallel.h"
#include "densify/agreement_check.h"
#include "densify/memory_limit.h"

namespace axial::densify {
namespace {

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

std::uint64_t least_bytes(const StageBytes& bytes, const ListLengths& lists,
                          std::size_t in_flight) {
  return std::max({matching(bytes, lists, in_flight), bytes.write_scene, bytes.exported,
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
  // Comparing maps (agreement_check.h) takes less memory than matching.
  const std::uint64_t for_maps = room - matching(bytes, lists, plan.in_flight) - more_images;
  plan.cached_depths = enlarged((lists.matched - 1) * plan.in_flight, bytes.depths, for_maps);
  plan.cached_maps =
      enlarged(std::max(lists.adjusted, kMapsCompared) * plan.in_flight, bytes.map, for_maps);

  const auto fuse = [&](std::size_t loads) { return fusing(bytes, lists.fused, loads); };
  plan.fusion_loads = most(std::min(threads, lists.fused), room - kept, fuse);
  plan.least_fused_maps = lists.fused;
  plan.marked_views = lists.marked;
  plan.exports = most(threads, room, [&](std::size_t k) { return k * bytes.exported; });
  plan.fused_maps = enlarged(lists.fused, bytes.fused, room - kept - fuse(plan.fusion_loads));
  return plan;
}

MemoryPlan plan_memory(const Project& project, const Settings& settings) {
  const ListLengths lists = longest_lists(project, settings);
  const StageBytes bytes = bytes_of_stages(project, settings, lists);
  const std::uint64_t limit = memory_limit(settings);
  const std::uint64_t fixed = bytes.scene + settings.survey.memory.program_bytes;
  const std::uint64_t least = fixed + least_bytes(bytes, lists, 1);
  if (limit < least)
    fail("{} {}: {} MB are too little, this scene needs {} MB", settings.name_of("max_memory"),
         settings.survey.memory.megabytes, limit / kMegabyte, least / kMegabyte + 1);
  const MemoryPlan plan = share_out(bytes, lists, limit - fixed, thread_count());
  log_details(
      "Memory {} MB, at least {}: {} images at a time, {} kept, {} depths, {} maps, {} in fusion",
      limit / kMegabyte, least / kMegabyte + 1, plan.in_flight, plan.cached_images,
      plan.cached_depths, plan.cached_maps, plan.fused_maps);
  return plan;
}

}  // namespace axial::densify
