// SPDX-License-Identifier: GPL-3.0-or-later
// The settings of one run of densify().
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "cloud/fuse.h"
#include "depth/filters.h"
#include "depth/options.h"
#include "scene/camera_list.h"
#include "scene/region.h"
#include "scene/view_selection.h"
#include "survey/options.h"

namespace axial::densify {

// Selects the depth maps of which pictures are written. The pictures (.png) lie beside the maps.
enum class Pictures { none, final_maps, maps_of_every_stage };

inline constexpr std::size_t kMostTiles = 1000;

// Bits of Settings::postprocess. Each bit switches on a filter for depth maps (depth/filters.h):
// remove_speckles(), fill_gaps() and adjust_with_neighbours(), in this order.
inline constexpr unsigned kSpeckles = 1, kGaps = 2, kAdjust = 4;

// Paths are absolute. `survey.files.scene`, `survey.files.working_folder` and `output` are
// required. Any other path may be empty. An empty path means "none", unless its comment says
// otherwise.
struct Settings {
  // The scene, its photographs and masks, and the memory of the run. The working folder also gets
  // the depth maps. All calibrated images are used. Errors and warnings name the fields of this
  // struct and of `survey` by survey.files.name_of.
  survey::Options survey;
  std::filesystem::path output;       // scene to write (.mvs); its cloud has the extension .ply
  std::filesystem::path point_cloud;  // sparse points (.ply); empty: the scene's own points
  // File that replaces computed lists of neighbours (neighbour_lists.h). Empty: all are computed.
  std::filesystem::path neighbour_lists;
  // If not empty, the run only writes the lists of neighbours to this file.
  std::filesystem::path neighbour_lists_output;
  std::filesystem::path report;  // file to write: results of the agreement check (.json)
  // Folder to write (pinhole_export.h). Precondition: empty, or `fuse` is true and the run makes
  // no other export.
  std::filesystem::path pinhole_export;
  std::vector<std::filesystem::path> other_inputs;  // the caller's files: never overwritten

  ProjectionMethod projection = ProjectionMethod::exact;

  ViewSelectionOptions selection;
  depth::PatchMatchOptions matching;
  depth::SpeckleOptions speckles;
  depth::GapOptions gaps;
  unsigned number_views = 0;     // source views of an image, at most 32; 0: all suitable views
  int geometric_iterations = 2;  // passes of refine_depth_map() (depth/patch_match.h), 0 or more
  unsigned postprocess = kSpeckles | kGaps;  // sum of the bits above; 0: no filter

  // densify() ignores the fields `normals`, `part`, max_maps and max_loads. estimate_normals
  // replaces `normals`, the tiles replace `part`, and the memory plan replaces the other two.
  cloud::FuseOptions fusion;
  bool make_maps = true;  // false: existing maps in the working folder are used unchanged
  bool fuse = true;       // false: the sparse points become the cloud
  // The number of tiles in which the maps are fused, one after the other (fusion_tiles.h), from 1
  // to kMostTiles. 1: the maps are fused in one piece. Precondition: 1 and no `tile`, or `fuse` is
  // true and neither estimate_colors nor estimate_normals is 1, because 1 needs the whole cloud.
  std::size_t fusion_tiles = 1;
  // From 1 to fusion_tiles: the run only makes this tile, from depth maps that are complete. 0: all
  // tiles and the cloud. Precondition: 0, or the run makes no export.
  std::size_t tile = 0;
  bool overwrite_dmaps = false;   // true: maps of other programs may be overwritten
  unsigned estimate_colors = 2;   // 0: no, 1: from the nearest view, 2: from all views of a point
  unsigned estimate_normals = 2;  // 0: no, 1: from the cloud, 2: from the depth maps
  // How the region of interest is estimated if the scene has none.
  RegionMode region = RegionMode::adaptive;
  // Changes the size of the region. A positive value multiplies the half extents. A negative value
  // adds its absolute value [world units] to each half extent. 0: no change.
  double roi_border = 0;
  bool crop_to_roi = true;    // leave out points of the dense cloud outside the region, if any
  bool remove_dmaps = false;  // remove the depth maps after fusion
  // Positions of the written cloud. True: double, in world coordinates. False: float, relative to
  // the scene's offset if it has one.
  bool double_precision = false;

  // The next three ask for an export of points instead of densifying (export_cloud() in
  // cloud_exports.h). With the default 0 of all three there is no export.
  int filter_point_cloud = 0;   // below 0: points of higher visibility; above 0: no effect
  int export_number_views = 0;  // N or -N: points that N or more images see; -N: also a scene
  double estimate_scale = 0;    // above 0: all points, with sizes of this number of pixels

  // The last stage to make: one of stage_names() (depth_stage.h). The run then writes depth maps,
  // but no cloud and no scene. Empty: all stages and the cloud.
  std::string until;
  // If `parts` is above 0, the run makes only the maps of the stage `until`, and only of the images
  // of one part (part_of() in project.h). `part` counts from 1. Runs of all parts, in any
  // order and at the same time, give the maps of one run without parts.
  std::size_t part = 0, parts = 0;
  // If not empty, the run only writes this file: the work of each stage (work_plan.h).
  std::filesystem::path plan;
  std::size_t planned_parts = 0;  // number of parts in the file `plan`; 0: by the work

  Pictures pictures = Pictures::none;
  unsigned max_threads = 0;  // largest number of threads; 0: as many as cores

  // How errors and warnings name `setting`, a field of this struct or of `survey`.
  std::string name_of(std::string_view setting) const { return survey.files.name_of(setting); }
};

// Whether the dense cloud takes colours from the images.
inline bool needs_colors(const Settings& settings) {
  return settings.fuse && settings.estimate_colors > 0;
}

// Whether the settings ask for an export of the scene's points instead of densifying.
inline bool only_exports(const Settings& settings) {
  return settings.filter_point_cloud < 0 || settings.export_number_views != 0 ||
         settings.estimate_scale > 0;
}

}  // namespace axial::densify
