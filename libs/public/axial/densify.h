// SPDX-License-Identifier: GPL-3.0-or-later
// From a scene with cameras and images to depth maps and a dense cloud: the run, and its options,
// one struct for each stage.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "axial/base.h"
#include "axial/cloud.h"
#include "axial/depth.h"
#include "axial/scene_images.h"
#include "axial/scene_options.h"
#include "axial/survey.h"

namespace axial::densify {

// How points, region of interest and source views are chosen.
struct ViewOptions {
  std::filesystem::path point_cloud;  // sparse points (.ply); empty: the scene's own points
  // File that replaces computed lists of neighbours. Empty: all are computed.
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

// Bits of MatchOptions::postprocess. Each bit switches on a filter for depth maps:
// remove_speckles(), fill_gaps() and adjust_with_neighbours(), in this order.
inline constexpr unsigned kSpeckles = 1, kGaps = 2, kAdjust = 4;

// The depth maps.
struct MatchOptions : depth::PatchMatchOptions {
  bool make_maps = true;  // false: existing maps in the working folder are used unchanged
  ProjectionMethod projection = ProjectionMethod::exact;
  int geometric_iterations = 2;              // passes of refine_depth_map(), 0 or more
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
  // The number of tiles in which the maps are fused, one after the other, from 1 to
  // 1000. 1: the maps are fused in one piece.
  std::size_t tiles = 1;
  unsigned estimate_colors = 2;   // 0: no, 1: from the nearest view, 2: from all views of a point
  unsigned estimate_normals = 2;  // 0: no, 1: from the cloud, 2: from the depth maps
  bool crop_to_roi = true;        // leave out points of the dense cloud outside the region, if any
  bool remove_dmaps = false;      // remove the depth maps after fusion

  bool needs_colors() const { return fuse && estimate_colors > 0; }  // of the photographs
};

// The results: the files that the run writes and must not write. `scene` is required. Any other
// path may be empty: none.
struct OutputOptions {
  std::filesystem::path scene;  // scene to write (.mvs); its cloud has the extension .ply
  // Positions of the written cloud. True: double, in world coordinates. False: float, relative to
  // the scene's offset if it has one.
  bool double_precision = false;
  std::filesystem::path report;                     // results of the agreement check (.json)
  std::filesystem::path pinhole_export;             // folder for images and scene as pinholes
  std::vector<std::filesystem::path> other_inputs;  // the caller's files: never overwritten
  // Gets the final depth maps before they are fused, one after the other. `image`:
  // index into Scene::images. The map is in the frame of the written scene. Empty: not called.
  std::function<void(std::size_t image, DepthMap map)> take_map;
};

// The job of a run. All depth maps, the cloud and the scene:
struct WholeRun {};

// The depth maps up to the stage `until`, one of stage_names() or "maps", but no cloud and no
// scene. If `parts` is above 0, only the maps of this stage, and only of the images of one part.
// `part` counts from 1. Runs of all parts, in any order and at the same time, give the maps of one
// run without parts.
struct StageJob {
  std::string until;
  std::size_t part = 0, parts = 0;
};

// One tile of the cloud, from depth maps that are complete. `tile`: from 1 to FusionOptions::tiles.
struct TileJob {
  std::size_t tile = 1;
};

// The file with the work of each stage. `parts`: in the file; 0: by the work.
struct PlanJob {
  std::filesystem::path file;
  std::size_t parts = 0;
};

// The file with the lists of neighbours.
struct NeighbourListsJob {
  std::filesystem::path file;
};

// An export of points instead of densifying. If several fields
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
  // depth maps, are required. All calibrated images are used.
  survey::Options survey;
  ViewOptions views;
  MatchOptions matching;
  FusionOptions fusion;
  OutputOptions output;
  Job job = WholeRun();

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
//   input and options are used again. The result has the same bytes for any
//   number of threads and any max_memory.
// * Inputs are never changed. An output file appears under its name only when it is complete.
// * Memory stays below the limit of Context::memory() (max_memory; if there is none, 70 % of the
//   free memory), and does not grow with the number of images, with three
//   exceptions: the scene, one bit per pixel in fusion (of the views of a tile), and a cloud whose
//   colours or normals are estimated from the whole cloud (estimate_colors or estimate_normals is
//   1). Such a cloud is kept in memory in addition to max_memory.
// * With TileJob the run makes only one tile of the cloud. With FusionOptions::tiles the run makes
//   the cloud from all tiles. A tile needs complete depth maps. Its points are those of the cloud
//   in one piece, except for a few near the borders of the tile.
// * `context` gets progress, results and warnings, and may stop the run. `observer`, unless it is
//   empty, is called once, before views are selected. It is not called for a point export.
// * Make only one run at a time. The bound of the memory holds if all threads share one heap
//   (mallopt(M_ARENA_MAX, 1) of glibc). From a run on, the process takes blocks of 1 MiB or more
//   directly from the system.
//
// Throws an Error for
// - options that contradict each other,
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

// The results of a run in memory.
struct MemoryResult {
  Report report;     // `cloud`: empty if the file is removed with the temporary folder
  PointCloud cloud;  // in `frame`; without errors and confidences of points
  LocalFrame frame;  // the world; for a scene far from the origin: a frame near the scene
};

// Makes depth maps and a cloud from a survey in memory. `options`: of a WholeRun. The files of
// options.survey need not be given; files of the scene, masks and the housing are not read.
// OutputOptions::take_map gets the depth maps.
//
// If survey.files.working_folder is given, the files of the run stay there, and a run that was
// stopped continues. Otherwise the files lie in a new folder in the system's folder of temporary
// files (TMPDIR). The run removes it, so that a run that was stopped starts again. If output.scene
// is empty, the scene is "dense.mvs" in the same folder. A stopped run ends when the images in work
// are done.
//
// Throws an Error as above, for check(survey), for another job, and for a pinhole export, which
// reads files of photographs.
MemoryResult densify(survey::MemorySurvey survey, Options options, const Context& context = {});

}  // namespace axial::densify
