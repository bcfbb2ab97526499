// SPDX-License-Identifier: GPL-3.0-or-later
// The entry of this library: from a scene with cameras and images to depth maps and a dense cloud.
#pragma once

#include <cstddef>
#include <filesystem>

#include "base/context.h"
#include "densify/options.h"

namespace axial::densify {

// What a run has written.
enum class Result {
  dense_cloud,      // depth maps, and the cloud fused from them
  sparse_cloud,     // depth maps; the cloud consists of the scene's points (FusionOptions::fuse:
                    // false)
  tile,             // one tile of the cloud (TileJob)
  point_export,     // see cloud_exports.h
  neighbour_lists,  // see neighbour_lists.h
  stage,            // depth maps of the stage StageJob::until, of all images or of a part
  plan              // see work_plan.h
};

// The result of densify().
struct Report {
  Result result = Result::dense_cloud;
  std::filesystem::path cloud;  // file of the cloud that was written; empty: none
  std::size_t points = 0;       // number of points of this cloud
  // Number of images whose depth map was made or used; exports, lists, plan: 0.
  std::size_t depth_maps = 0;
  // For dense_cloud and sparse_cloud: whether no camera has a port or a distorted lens. Only then
  // do OpenMVS's programs read the depth maps and the scene correctly. Otherwise true, without a
  // meaning.
  bool only_pinholes = true;
};

// Makes the depth map of every suitable image of the scene, fuses the maps to a cloud, and writes
// the maps, the cloud, and the scene with its housing, lenses and offset. A run with another job
// than WholeRun (Options::job) writes other files instead (Result).
//
// * A run that was stopped continues where it ended: depth maps of an earlier run with the same
//   input and options are used again (map_stages.h). The result has the same bytes for any
//   number of threads and any max_memory.
// * Inputs are never changed. An output file appears under its name only when it is complete.
// * Memory stays below the limit of Context::memory() (max_memory; if there is none, 70 % of the
//   free memory), and does not grow with the number of images, with three
//   exceptions: the scene, one bit per pixel in fusion (of the views of a tile), and a cloud whose
//   colours or normals are estimated from the whole cloud (estimate_colors or estimate_normals is
//   1). Such a cloud is kept in memory in addition to max_memory.
// * With TileJob the run makes only one tile of the cloud. With FusionOptions::tiles the run makes
//   the cloud from all tiles. A tile needs complete depth maps. Its points are those of the cloud
//   in one piece, except for a few near the borders of the tile (tiles.h).
// * `context` gets progress, results and warnings, and may stop the run. `observer`, unless it is
// empty, is
//   called once, before views are selected. It is not called for a point export.
// * Make only one run at a time. The bound of the memory holds if the program has called
//   share_one_heap() (base/memory.h). The run calls map_large_blocks(), which has an effect on the
//   process after the run, too.
//
// Throws an Error for
// - options that contradict each other (check() in options.h),
// - a fault of the scene or of a file that belongs to the scene,
// - an image that is missing, truncated, damaged or of another shape than its camera,
// - an output that cannot be written, or that is an input,
// - depth maps of other programs in the working folder, unless overwrite_dmaps is set or the run
//   makes no maps,
// - too little memory,
// - a scene of which no image can get a depth map.
// All this is checked before the first depth map is made. Precondition: each number is in the
// range that its comment, or the comment of its type, names.
Report densify(const Options& options, const SceneObserver& observer = {},
               const Context& context = {});

}  // namespace axial::densify
