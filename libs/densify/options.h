// SPDX-License-Identifier: GPL-3.0-or-later
// The options of one run of densify(): one struct for each stage, and what the run makes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "cloud/fuse.h"
#include "depth/filters.h"
#include "depth/options.h"
#include "scene/camera_list.h"
#include "scene/region.h"
#include "scene/view_selection.h"
#include "survey/options.h"

namespace axial::densify {

// How points, region of interest and source views are chosen.
struct ViewOptions {
  std::filesystem::path point_cloud;  // sparse points (.ply); empty: the scene's own points
  // File that replaces computed lists of neighbours (neighbour_lists.h). Empty: all are computed.
  std::filesystem::path neighbour_lists;
  ViewSelectionOptions selection;
  unsigned number_views = 0;  // source views of an image, at most 32; 0: all suitable views
  // How the region of interest is estimated if the scene has none.
  RegionMode region = RegionMode::adaptive;
  // Changes the size of the region. A positive value multiplies the half extents. A negative value
  // adds its absolute value [world units] to each half extent. 0: no change.
  double roi_border = 0;
};

// Selects the depth maps of which pictures are written. The pictures (.png) lie beside the maps.
enum class Pictures { none, final_maps, maps_of_every_stage };

// Bits of MatchOptions::postprocess. Each bit switches on a filter for depth maps
// (depth/filters.h): remove_speckles(), fill_gaps() and adjust_with_neighbours(), in this order.
inline constexpr unsigned kSpeckles = 1, kGaps = 2, kAdjust = 4;

// The depth maps.
struct MatchOptions : depth::PatchMatchOptions {
  bool make_maps = true;  // false: existing maps in the working folder are used unchanged
  ProjectionMethod projection = ProjectionMethod::exact;
  int geometric_iterations = 2;  // passes of refine_depth_map() (depth/patch_match.h), 0 or more
  unsigned postprocess = kSpeckles | kGaps;  // sum of the bits above; 0: no filter
  depth::SpeckleOptions speckles;
  depth::GapOptions gaps;
  bool overwrite_dmaps = false;  // true: maps of other programs may be overwritten
  Pictures pictures = Pictures::none;
};

// The cloud. The fields `normals`, `part`, max_maps and max_loads have no effect: estimate_normals
// replaces `normals`, the tiles replace `part`, and the memory plan replaces the other two.
struct FusionOptions : cloud::FuseOptions {
  bool fuse = true;  // false: the sparse points become the cloud
  // The number of tiles in which the maps are fused, one after the other (tiles.h), from 1 to
  // kMostTiles (base/tiling.h). 1: the maps are fused in one piece.
  std::size_t tiles = 1;
  unsigned estimate_colors = 2;   // 0: no, 1: from the nearest view, 2: from all views of a point
  unsigned estimate_normals = 2;  // 0: no, 1: from the cloud, 2: from the depth maps
  bool crop_to_roi = true;        // leave out points of the dense cloud outside the region, if any
  bool remove_dmaps = false;      // remove the depth maps after fusion

  bool needs_colors() const { return fuse && estimate_colors > 0; }  // of the photographs
};

// The files that the run writes and must not write. `scene` is required. Any other path may be
// empty: none.
struct OutputOptions {
  std::filesystem::path scene;  // scene to write (.mvs); its cloud has the extension .ply
  // Positions of the written cloud. True: double, in world coordinates. False: float, relative to
  // the scene's offset if it has one.
  bool double_precision = false;
  std::filesystem::path report;                     // results of the agreement check (.json)
  std::filesystem::path pinhole_export;             // folder (pinhole_export.h)
  std::vector<std::filesystem::path> other_inputs;  // the caller's files: never overwritten
};

// The job of a run. All depth maps, the cloud and the scene:
struct WholeRun {};

// The depth maps up to the stage `until`, one of stage_names() or "maps", but no cloud and no
// scene. If `parts` is above 0, only the maps of this stage, and only of the images of one part
// (part_of() in project.h). `part` counts from 1. Runs of all parts, in any order and at the same
// time, give the maps of one run without parts.
struct StageJob {
  std::string until;
  std::size_t part = 0, parts = 0;
};

// One tile of the cloud, from depth maps that are complete. `tile`: from 1 to FusionOptions::tiles.
struct TileJob {
  std::size_t tile = 1;
};

// The file with the work of each stage (work_plan.h). `parts`: in the file; 0: by the work.
struct PlanJob {
  std::filesystem::path file;
  std::size_t parts = 0;
};

// The file with the lists of neighbours (neighbour_lists.h).
struct NeighbourListsJob {
  std::filesystem::path file;
};

// An export of points instead of densifying (export_cloud() in cloud_exports.h). If several fields
// ask for a cloud, only the first is written.
struct ExportJob {
  int filter_point_cloud = 0;   // below 0: points of higher visibility; above 0: no effect
  int export_number_views = 0;  // N or -N: points that N or more images see; -N: also a scene
  double estimate_scale = 0;    // above 0: all points, with sizes of this number of pixels

  // Whether a field asks for a cloud.
  bool any() const {
    return filter_point_cloud < 0 || export_number_views != 0 || estimate_scale > 0;
  }
};

using Job = std::variant<WholeRun, StageJob, TileJob, PlanJob, NeighbourListsJob, ExportJob>;

// The options of a run. Paths are absolute.
struct Options {
  // The scene, its photographs and masks. The scene and the working folder, which also gets the
  // depth maps, are required. All calibrated images are used. Errors and warnings name the options
  // by survey.files.name_of.
  survey::Options survey;
  ViewOptions views;
  MatchOptions matching;
  FusionOptions fusion;
  OutputOptions output;
  Job job = WholeRun();

  std::string name_of(std::string_view option) const { return survey.files.name_of(option); }

  // The job if it is of this kind, otherwise null.
  template <class Kind>
  const Kind* job_as() const {
    return std::get_if<Kind>(&job);
  }
};

// Throws an Error, which names an option and its value, if options contradict each other or the
// job:
// - StageJob::until is not the name of a stage, or `part` is not from 1 to `parts`,
// - a stage or a plan of a run that makes no maps (MatchOptions::make_maps),
// - a pinhole export by a run that makes no cloud, or only a tile of it,
// - tiles without fusion, or with colours or normals of the whole cloud (estimate_colors or
//   estimate_normals is 1), or a tile that is not from 1 to FusionOptions::tiles.
void check(const Options& options);

// The names of the stages of the depth maps, in their order: "photometric", "geometric1",
// "geometric2", ..., and "adjusted" if MatchOptions::postprocess asks for the adjust filter.
std::vector<std::string> stage_names(const MatchOptions& options);

// The number of stages up to the stage `until`: 1 for the first. "maps" means the last stage.
// 0 if `until` is neither "maps" nor the name of a stage.
std::size_t stages_until(const std::string& until, const MatchOptions& options);

// Properties of a scene that are known before its views are selected.
struct SceneFacts {
  // At least one image is behind a port. False if the options ignore the ports
  // (io::PortChoice::ignored).
  bool behind_ports = false;
  bool own_region = false;  // the scene file contains a region of interest
  // The run has a region of interest: the region of the scene file, or else an estimated region.
  bool region = false;
};

// A function that receives the facts. densify() says when it is called. It may be empty.
using SceneObserver = std::function<void(const SceneFacts&)>;

}  // namespace axial::densify
