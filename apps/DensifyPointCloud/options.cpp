// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <cmath>

#include "base/error.h"
#include "base/fraction.h"
#include "base/log.h"
#include "base/program/option_values.h"
#include "base/program/output_name.h"
#include "base/program/tiling.h"
#include "base/program/unused_input.h"
#include "base/version.h"
#include "dense_config.h"
#include "io/images/bit_depth.h"
#include "survey/photograph_options.h"
#include "without_effect.h"

namespace axial::apps {
namespace {

// The values of the command line before they are checked and converted.
struct Raw {
  densify::StageJob stage;
  densify::PlanJob plan;
  densify::NeighbourListsJob lists;
  densify::ExportJob points;
  std::string tile;
  std::size_t fusion_tiles = 1;
  bool refractive = false;
  std::filesystem::path dense_config;
  int fusion_mode = 0, tower_mode = 0;
  double estimate_roi = 2;
};

void take_part(const std::string& part, densify::StageJob& job) {
  constexpr std::size_t kMostParts = 1000000;
  const Fraction fraction = parse_fraction("--part", part, kMostParts);
  job.part = fraction.part;
  job.parts = fraction.count;
}

void declare_io(OptionList& list, densify::Options& settings) {
  list.add("input-file,i", &settings.survey.files.scene, "scene with cameras and images")
      .add("output-file,o", &settings.output.scene, "scene and cloud to write (<input>_dense.mvs)")
      .output_file()
      .sets("output")
      .add_with_default("resolution-level", &settings.survey.resolution.level,
                        "how many times the images are halved before matching")
      .range(0, 16)
      .add_with_default("max-resolution", &settings.survey.resolution.max,
                        "largest length of the longest side [px]")
      .range(16, 1 << 16)
      .add_with_default("min-resolution", &settings.survey.resolution.min,
                        "the longest side is not halved below this [px]")
      .range(1, 1 << 16)
      .add("mask-path", &settings.survey.mask_folder,
           "folder with a mask for every image: a.mask.png, a.jpg.png, a_mask.png or a.png for "
           "a.jpg, in the same subfolders as the images")
      .sets("mask_folder")
      .add_with_default("ignore-mask-label", &settings.survey.ignore_mask_label,
                        "mask value to leave out; below 0: no masks (default with --mask-path: 0)")
      .add_choice("output-precision", &settings.output.double_precision,
                  {{"float", false}, {"double", true}},
                  "precision of the cloud's positions: float, relative to the scene's offset "
                  "if it has one (<scene>.geo.json), or double, in world coordinates")
      .add("pinhole-export", &settings.output.pinhole_export,
           "folder to write photographs, depth maps, cloud and scene to, resampled into pinhole "
           "cameras for OpenMVS's later programs, and a COLMAP model for trainers of splats")
      .output_folder()
      .add("report-file", &settings.output.report,
           "write the agreement of depth maps, sparse points and cameras to this file (.json)")
      .output_file()
      .sets("report")
      .add_with_default("remove-dmaps", &settings.fusion.remove_dmaps,
                        "remove the depth maps after fusion")
      .add_with_default("overwrite-dmaps", &settings.matching.overwrite_dmaps,
                        "overwrite depth maps of other programs in the working folder")
      .sets("overwrite_dmaps true", " 1")
      .add_max_memory(
          kProgramBytes,
          "largest memory to use [MB] (0: 70 % of the free memory); --estimate-colors 1 and "
          "--estimate-normals 1 keep the whole cloud in additional memory");
}

void declare_parts(OptionList& list, Raw& raw) {
  list.add("until", &raw.stage.until,
           "stop after this stage and write no cloud: photometric, geometric1, geometric2 and so "
           "on, "
           "adjusted, or maps, the last of them")
      .add_text(
          "part", [&](const std::string& text) { take_part(text, raw.stage); },
          "I/N: make only the depth maps of the stage --until, and only of the I-th of N parts of "
          "the images; the runs of all parts can share a folder")
      .add("plan", &raw.plan.file,
           "write stages, number of parts, CPU time and memory of each part to this file (.json) "
           "and quit")
      .output_file()
      .add_with_default("plan-parts", &raw.plan.parts,
                        "number of parts in the plan (0: a part takes about ten minutes)");
}

void declare_matching(OptionList& list, densify::Options& settings) {
  list.add_with_default("sub-resolution-levels", &settings.matching.sub_resolution_levels,
                        "number of coarser levels that are matched first")
      .range(0, 8)
      .add_with_default(
          "number-views", &settings.views.number_views,
          "source views per image (0: all suitable views, at most 12; 1: the best view)")
      .range(0, 32)
      .add_with_default("iters", &settings.matching.iterations, "sweeps per resolution level")
      .range(1, 60)
      .add_with_default("geometric-iters", &settings.matching.geometric_iterations,
                        "sweeps with geometric consistency")
      .range(0, 20)
      .add_with_default("postprocess-dmaps", &settings.matching.postprocess,
                        "sum of the depth map filters: 1 speckles, 2 gaps, 4 adjustment to the "
                        "neighbours' maps (OpenMVS's default is 7)")
      .range(0, 7);
}

void declare_fusion(OptionList& list, Raw& raw, densify::Options& settings) {
  list.add_with_default(
          "fusion-mode", &raw.fusion_mode,
          "0 depth maps and fusion, 1 depth maps only, -1 fusion of the existing depth maps in the "
          "working folder, also of other programs, without writing depth maps")
      .sets("make_maps false", " -1")
      .add_with_default("number-views-fuse", &settings.fusion.min_views,
                        "views that must agree on a point (below 2: merge without agreement); by "
                        "default 3, and 2 where no other depth map disagrees")
      .range(0, 255)
      .sets("fusion.min_views")
      .add_with_default("estimate-colors", &settings.fusion.estimate_colors,
                        "0 no, 1 from the nearest view, 2 from all views of a point")
      .range(0, 2)
      .sets("estimate_colors 1", " 1")
      .add_with_default("estimate-normals", &settings.fusion.estimate_normals,
                        "0 no, 1 from the cloud, 2 from the depth maps")
      .range(0, 2)
      .sets("estimate_normals 1", " 1")
      .add_with_default("estimate-uncertainty", &settings.fusion.errors,
                        "also write each point's expected error [m] and confidence")
      .add_with_default("estimate-roi", &raw.estimate_roi,
                        "region of interest from cameras and points: 0 off, 1 on, 2 adaptive (also "
                        "1.1, the default of OpenMVS 2.4)")
      .range(0, 2)
      .add_with_default("roi-border", &settings.views.roi_border,
                        "above 0 multiplies the region's size, below 0 adds to it [scene units]")
      .range(-1e6, 1e6)
      .add_with_default("crop-to-roi", &settings.fusion.crop_to_roi,
                        "crop the cloud to the region of interest")
      .add_with_default("tiles", &settings.fusion.tiles,
                        "fuse in this number of tiles, one after the other; tiles that exist "
                        "already (see --tile) are used; --fusion-tiles is the same option")
      .range(1, kMostTiles)
      .add("tile", &raw.tile,
           "I/N: make only tile I of N from complete depth maps, write it to "
           "<output>.tileI-N.ply and quit; a run with --tiles N joins the tiles");
}

void declare_points(OptionList& list, Raw& raw, densify::Options& settings) {
  list.add("pointcloud-file,p", &settings.views.point_cloud,
           "PLY cloud with views that replaces the scene's sparse points")
      .add("view-neighbors-file", &settings.views.neighbour_lists,
           "text file of neighbours: for each image a line with its index and the indices of its "
           "neighbours, best first")
      .add("output-view-neighbors-file", &raw.lists.file, "write a file of neighbours and quit")
      .output_file()
      .sets("neighbour_lists_output")
      .add_with_default(
          "filter-point-cloud", &raw.points.filter_point_cloud,
          "below 0: write the points of the scene, or of -p, whose visibility is above this value "
          "to <output>_filtered.ply and .mvs, and quit; above 0: no effect")
      .range(-(1 << 30), 1 << 30)
      .add_with_default("export-number-views", &raw.points.export_number_views,
                        "N: write the points that N or more images see to <output>_<N>views.ply "
                        "and quit; -N: also write .mvs")
      .range(-255, 255)
      .add_with_default("estimate-scale", &raw.points.estimate_scale,
                        "above 0: write the points and their sizes, this number of pixels in their "
                        "views, to <output>_scale.ply and quit")
      .range(0, 1e6)
      .add_with_default("tower-mode", &raw.tower_mode, "accepted and without effect")
      .range(-4, 4)
      .add("dense-config-file", &raw.dense_config,
           "OpenMVS's Densify.ini: settings that have no option; written if it does not exist");
}

void declare_camera(OptionList& list, Raw& raw, densify::Options& settings) {
  using io::PortChoice;
  list.add_switch("refractive", &raw.refractive, "cameras are behind ports: require a housing file")
      .add("housing", &settings.survey.files.housing, "housing file (<scene>.housing.json)")
      .add_choice("camera-model", &settings.survey.files.ports,
                  {{"auto", PortChoice::automatic},
                   {"pinhole", PortChoice::ignored},
                   {"flatport", PortChoice::flat}},
                  "auto: as in the housing file, pinhole: ignore the housing file, flatport: "
                  "require a flat port for every image")
      .sets("camera is flat_port", " is flatport")
      .add_choice(
          "projection", &settings.matching.projection,
          {{"exact", ProjectionMethod::exact}, {"line-search", ProjectionMethod::line_search}},
          "projection in matching: exact, or line-search as published")
      .add_choice("warp", &settings.matching.warp,
                  {{"affine", depth::Warp::affine}, {"homography", depth::Warp::homography}},
                  "warp in matching: affine (exact to first order), or homography, the "
                  "published virtual homography");
}

// The rules that need more than a range.
void check_values(const Raw& raw) {
  if (raw.fusion_mode == -2)
    fail("--fusion-mode -2: disparity maps are not built; -1 fuses existing depth maps");
  check_range("fusion-mode", raw.fusion_mode, -1, 1);
  if (const double value = raw.estimate_roi; value != 1.1 && value != std::floor(value))
    fail("--estimate-roi {}: must be 0, 1 or 2; 1.1, the default of OpenMVS 2.4, means 2", value);
}

// Warns of valid options that have no effect.
void warn_of_no_effect(const Raw& raw) {
  if (raw.tower_mode != 0)
    log_warning(
        "--tower-mode {}: not built: as with 0, no points are added around a line of cameras",
        raw.tower_mode);
  if (raw.points.filter_point_cloud > 0)
    log_warning(
        "--filter-point-cloud {}: has no effect, as in OpenMVS: only values below 0 filter, and "
        "they filter only an existing cloud (-p)",
        raw.points.filter_point_cloud);
}

void take_paths(const CommonOptions& common, densify::Options& settings) {
  std::filesystem::path& output = settings.output.scene;
  refuse_other_format(output, "--output-file");
  settings.survey.files.working_folder = common.working_folder;
  output = with_extension(
      output_or(output, without_known_extension(settings.survey.files.scene) += "_dense",
                "--output-file"),
      ".mvs");
}

void require_ports(io::PortChoice& ports) {
  if (ports == io::PortChoice::ignored) fail("--refractive contradicts --camera-model pinhole");
  if (ports == io::PortChoice::automatic) ports = io::PortChoice::required;
}

// From -v 3 on, pictures of the depth maps are written beside them, as by OpenMVS. From -v 5 on,
// pictures of the maps of every stage, too.
densify::Pictures pictures_of(int verbosity) {
  using densify::Pictures;
  if (verbosity < 3) return Pictures::none;
  return verbosity < 5 ? Pictures::final_maps : Pictures::maps_of_every_stage;
}

// The job that the options ask for. Error if they ask for several.
densify::Job job_of(const Raw& raw, const ParsedOptions& parsed) {
  const bool stage = !raw.stage.until.empty(), plan = !raw.plan.file.empty();
  const bool points = raw.points.any() || !raw.lists.file.empty();
  const bool tile = given(parsed, "tile");
  if (raw.stage.parts > 0 && !stage) return raw.stage;  // densify::check() refuses it
  if (stage && points) fail("--until {}: this run makes no depth maps", raw.stage.until);
  if (plan && (points || stage))
    fail("--plan {}: plans only runs that make all depth maps", raw.plan.file.string());
  if (tile && points) fail("--tile {}: needs fusion, which this run does not make", raw.tile);
  if (tile && (stage || plan))
    fail("--tile {}: contradicts --until and --plan, which fuse nothing", raw.tile);
  if (raw.points.any()) return raw.points;
  if (points) return raw.lists;
  if (plan) return raw.plan;
  if (stage) return raw.stage;
  if (tile) return densify::TileJob();
  return densify::WholeRun();
}

// Takes --fusion-tiles, the earlier name of --tiles, and --tile.
void take_tiling(const Raw& raw, ParsedOptions& parsed, densify::Options& settings) {
  std::size_t& tiles = settings.fusion.tiles;
  if (given(parsed, "fusion-tiles")) {
    if (given(parsed, "tiles") && tiles != raw.fusion_tiles)
      fail("--fusion-tiles {}: contradicts --tiles {}", raw.fusion_tiles, tiles);
    tiles = raw.fusion_tiles;
    parsed.given.insert("tiles");
  }
  if (!settings.job_as<densify::TileJob>()) return;
  Tiling tiling{tiles};
  take_tile(raw.tile, parsed, tiling);
  tiles = tiling.count;
  settings.job = densify::TileJob{*tiling.tile};
}

// Fills the settings from the values of the options.
void convert(const Raw& raw, Options& options) {
  densify::Options& settings = options.settings;
  const CommonOptions& common = options.parsed.common;
  if (!raw.dense_config.empty()) {
    apply_dense_config(raw.dense_config, settings);
    settings.output.other_inputs.push_back(raw.dense_config);
  }
  take_paths(common, settings);
  if (!settings.survey.mask_folder.empty() && !given(options.parsed, "ignore-mask-label"))
    settings.survey.ignore_mask_label = 0;
  if (raw.refractive) require_ports(settings.survey.files.ports);
  settings.matching.make_maps = raw.fusion_mode >= 0;
  settings.fusion.fuse = raw.fusion_mode <= 0;
  settings.views.region = raw.estimate_roi == 1.1 ? RegionMode::adaptive
                                                  : static_cast<RegionMode>(int(raw.estimate_roi));
  settings.fusion.two_if_undisputed = !given(options.parsed, "number-views-fuse");
  settings.matching.pictures = pictures_of(common.verbosity);
  settings.job = job_of(raw, options.parsed);
  take_tiling(raw, options.parsed, settings);
  densify::check(settings);
}

ProgramOptions described_program() {
  ProgramOptions program{
      "DensifyPointCloud",
      "computes a dense point cloud from calibrated images, in air and under water",
      OptionList("Densify options"), OptionList("Hidden options"),
      ", and pictures of the depth maps in the same folder; 5 and above: also pictures of the "
      "depth maps of every stage"};
  program.version = version_line(program.name);
  return program;
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  densify::Options& settings = options.settings;
  Raw raw;
  ProgramOptions program = described_program();
  declare_io(program.visible, settings);
  io::declare_bit_depth(program.visible, settings.survey.bit_depth);
  survey::declare_colors(program.visible, settings.survey);
  program.visible
      .add_switch("match-restored", &settings.survey.match_colors,
                  "match the photographs of --colors, too: they show more in hazy water")
      .sets("match_colors");
  declare_camera(program.visible, raw, settings);
  declare_matching(program.visible, settings);
  declare_parts(program.visible, raw);
  declare_fusion(program.visible, raw, settings);
  declare_points(program.visible, raw, settings);
  UnusedInput::declare(program.visible, settings.survey.files.allow_missing);
  program.visible.add_not_built("sub-scene-area", "0", {"0", "0.0"})
      .add_not_built("sample-mesh", "0", {"0", "0.0"})
      .add_not_built("cuda-device", "-1", {"-1", "-2"});
  program.hidden.add("fusion-tiles", &raw.fusion_tiles, "the same as --tiles").range(1, kMostTiles);
  for (const char* name :
       {"mesh-file", "export-roi-file", "import-roi-file", "export-depth-maps-name"})
    program.hidden.add_not_built(name, "", {""});
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  check_values(raw);
  warn_of_no_effect(raw);
  convert(raw, options);
  warn_of_options_without_effect(options);
  return options;
}

}  // namespace axial::apps
