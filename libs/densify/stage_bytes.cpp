// SPDX-License-Identifier: GPL-3.0-or-later
#include "densify/stage_bytes.h"

#include <algorithm>

#include "base/memory.h"
#include "cloud/fuse.h"
#include "densify/fusion_tiles.h"
#include "densify/pinhole_export.h"
#include "depth/filters.h"
#include "depth/patch_match.h"
#include "io/images/image.h"
#include "io/openmvs/dmap.h"
#include "io/openmvs/mvs_counts.h"
#include "survey/image_store.h"

namespace axial::densify {

ListLengths longest_lists(const Project& project, const Settings& settings) {
  ListLengths lists;
  lists.references = project.references.size();
  for (const std::size_t image : project.references) {
    lists.matched = std::max(lists.matched, 1 + project.sources[image].size());
    lists.fused = std::max(lists.fused, 1 + project.neighbours[image].size());
  }
  lists.fused = std::min(lists.fused, lists.references);
  lists.marked = settings.fuse && settings.fusion_tiles > 1
                     ? most_views_of_a_tile(project, settings)
                     : lists.references;
  if (settings.postprocess & kAdjust)
    lists.adjusted = std::min(lists.fused, 1 + depth::AdjustOptions().max_neighbours);
  return lists;
}

StageBytes bytes_of_stages(const Project& project, const Settings& settings,
                           const ListLengths& lists) {
  std::uint64_t pixels = 0, decode = 0;
  bool masks = false;
  StageBytes bytes;
  for (const View& view : project.views) {
    if (!settings.pinhole_export.empty())
      bytes.exported = std::max(bytes.exported, bytes_needed_to_resample(view));
    pixels = std::max(pixels, static_cast<std::uint64_t>(view.camera.width) *
                                  static_cast<std::uint64_t>(view.camera.height));
    decode = std::max(decode, io::bytes_needed(view.header));
    masks |= view.masked();
  }
  const bool colors = needs_colors(settings);
  bytes.scene = allocated_memory();
  bytes.write_scene = io::count_scene(project.scene).writing_bytes();
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

}  // namespace axial::densify
