// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <cmath>
#include <vector>

#include "base/error.h"
#include "base/fraction.h"
#include "base/log.h"
#include "base/not_built.h"
#include "base/output_name.h"
#include "base/unused_input.h"
#include "base/version.h"
#include "dense_config.h"
#include "io/images/bit_depth.h"
#include "option_names.h"
#include "tile_option.h"
#include "without_effect.h"

namespace axial::apps {
using densify::Settings;

namespace {

// The values of the command line before they are checked and converted.
struct Raw {
  std::string input, output, housing, mask_path;
  std::string point_cloud, neighbour_lists, neighbour_lists_output, dense_config, pinhole_export;
  std::string report, part, plan, tile;
  std::string camera_model = "auto", projection = "exact", warp = "affine", precision = "float";
  bool refractive = false;
  int fusion_mode = 0, tower_mode = 0;
  double estimate_roi = 2;
};

std::vector<NotBuilt> not_built() {
  return {{"sub-scene-area", "0", {"0", "0.0"}},
          {"sample-mesh", "0", {"0", "0.0"}},
          {"cuda-device", "-1", {"-1", "-2"}}};
}

std::vector<NotBuilt> not_built_hidden() {
  return {{"mesh-file", "", {""}},
          {"export-roi-file", "", {""}},
          {"import-roi-file", "", {""}},
          {"export-depth-maps-name", "", {""}}};
}

void declare_io(OptionList& list, Raw& raw, Settings& settings) {
  list.add("input-file,i", &raw.input, "scene with cameras and images")
      .add("output-file,o", &raw.output, "scene and cloud to write (<input>_dense.mvs)")
      .add_with_default("resolution-level", &settings.survey.resolution.level,
                        "how many times the images are halved before matching")
      .add_with_default("max-resolution", &settings.survey.resolution.max,
                        "largest length of the longest side [px]")
      .add_with_default("min-resolution", &settings.survey.resolution.min,
                        "the longest side is not halved below this [px]")
      .add("mask-path", &raw.mask_path,
           "folder with a mask for every image: a.mask.png, a.jpg.png, a_mask.png or a.png for "
           "a.jpg, in the same subfolders as the images")
      .add_with_default("ignore-mask-label", &settings.survey.ignore_mask_label,
                        "mask value to leave out; below 0: no masks (default with --mask-path: 0)")
      .add_with_default("output-precision", &raw.precision,
                        "precision of the cloud's positions: float, relative to the scene's offset "
                        "if it has one (<scene>.geo.json), or double, in world coordinates")
      .add("pinhole-export", &raw.pinhole_export,
           "folder to write photographs, depth maps, cloud and scene to, resampled into pinhole "
           "cameras for OpenMVS's later programs")
      .add("report-file", &raw.report,
           "write the agreement of depth maps, sparse points and cameras to this file (.json)")
      .add_with_default("remove-dmaps", &settings.remove_dmaps,
                        "remove the depth maps after fusion")
      .add_with_default("overwrite-dmaps", &settings.overwrite_dmaps,
                        "overwrite depth maps of other programs in the working folder")
      .add_with_default(
          "max-memory", &settings.survey.memory.megabytes,
          "largest memory to use [MB] (0: 70 % of the free memory); --estimate-colors 1 and "
          "--estimate-normals 1 keep the whole cloud in additional memory");
}

void declare_parts(OptionList& list, Raw& raw, Settings& settings) {
  list.add("until", &settings.until,
           "stop after this stage and write no cloud: photometric, geometric1, geometric2 and so "
           "on, "
           "adjusted, or maps, the last of them")
      .add("part", &raw.part,
           "I/N: make only the depth maps of the stage --until, and only of the I-th of N parts of "
           "the images; the runs of all parts can share a folder")
      .add("plan", &raw.plan,
           "write stages, number of parts, CPU time and memory of each part to this file (.json) "
           "and quit")
      .add_with_default("plan-parts", &settings.planned_parts,
                        "number of parts in the plan (0: a part takes about ten minutes)");
}

void declare_matching(OptionList& list, Settings& settings) {
  list.add_with_default("sub-resolution-levels", &settings.matching.sub_resolution_levels,
                        "number of coarser levels that are matched first")
      .add_with_default(
          "number-views", &settings.number_views,
          "source views per image (0: all suitable views, at most 12; 1: the best view)")
      .add_with_default("iters", &settings.matching.iterations, "sweeps per resolution level")
      .add_with_default("geometric-iters", &settings.geometric_iterations,
                        "sweeps with geometric consistency")
      .add_with_default("postprocess-dmaps", &settings.postprocess,
                        "sum of the depth map filters: 1 speckles, 2 gaps, 4 adjustment to the "
                        "neighbours' maps (OpenMVS's default is 7)");
}

void declare_fusion(OptionList& list, Raw& raw, Settings& settings) {
  list.add_with_default(
          "fusion-mode", &raw.fusion_mode,
          "0 depth maps and fusion, 1 depth maps only, -1 fusion of the existing depth maps in the "
          "working folder, also of other programs, without writing depth maps")
      .add_with_default("number-views-fuse", &settings.fusion.min_views,
                        "views that must agree on a point (below 2: merge without agreement); by "
                        "default 3, and 2 where no other depth map disagrees")
      .add_with_default("estimate-colors", &settings.estimate_colors,
                        "0 no, 1 from the nearest view, 2 from all views of a point")
      .add_with_default("estimate-normals", &settings.estimate_normals,
                        "0 no, 1 from the cloud, 2 from the depth maps")
      .add_with_default("estimate-uncertainty", &settings.fusion.errors,
                        "also write each point's expected error [m] and confidence")
      .add_with_default("estimate-roi", &raw.estimate_roi,
                        "region of interest from cameras and points: 0 off, 1 on, 2 adaptive (also "
                        "1.1, the default of OpenMVS 2.4)")
      .add_with_default("roi-border", &settings.roi_border,
                        "above 0 multiplies the region's size, below 0 adds to it [scene units]")
      .add_with_default("crop-to-roi", &settings.crop_to_roi,
                        "crop the cloud to the region of interest")
      .add_with_default("fusion-tiles", &settings.fusion_tiles,
                        "fuse in this number of tiles, one after the other; tiles that exist "
                        "already (see --tile) are used")
      .add("tile", &raw.tile,
           "I/N: make only tile I of N from complete depth maps, write it to "
           "<output>.tileI-N.ply and quit; a run with --fusion-tiles N joins the tiles");
}

void declare_points(OptionList& list, Raw& raw, Settings& settings) {
  list.add("pointcloud-file,p", &raw.point_cloud,
           "PLY cloud with views that replaces the scene's sparse points")
      .add("view-neighbors-file", &raw.neighbour_lists,
           "text file of neighbours: for each image a line with its index and the indices of its "
           "neighbours, best first")
      .add("output-view-neighbors-file", &raw.neighbour_lists_output,
           "write a file of neighbours and quit")
      .add_with_default(
          "filter-point-cloud", &settings.filter_point_cloud,
          "below 0: write the points of the scene, or of -p, whose visibility is above this value "
          "to <output>_filtered.ply and .mvs, and quit; above 0: no effect")
      .add_with_default("export-number-views", &settings.export_number_views,
                        "N: write the points that N or more images see to <output>_<N>views.ply "
                        "and quit; -N: also write .mvs")
      .add_with_default("estimate-scale", &settings.estimate_scale,
                        "above 0: write the points and their sizes, this number of pixels in their "
                        "views, to <output>_scale.ply and quit")
      .add_with_default("tower-mode", &raw.tower_mode, "accepted and without effect")
      .add("dense-config-file", &raw.dense_config,
           "OpenMVS's Densify.ini: settings that have no option; written if it does not exist");
}

void declare_camera(OptionList& list, Raw& raw) {
  list.add_switch("refractive", &raw.refractive, "cameras are behind ports: require a housing file")
      .add("housing", &raw.housing, "housing file (<scene>.housing.json)")
      .add_with_default("camera-model", &raw.camera_model,
                        "auto: as in the housing file, pinhole: ignore the housing file, flatport: "
                        "require a flat port for every image")
      .add_with_default("projection", &raw.projection,
                        "projection in matching: exact, or line-search as published")
      .add_with_default("warp", &raw.warp,
                        "warp in matching: affine (exact to first order), or homography, the "
                        "published virtual homography");
}

template <class T>
T one_of(const std::string& name, const std::string& value,
         const std::vector<std::pair<std::string, T>>& choices) {
  std::string names;
  for (const auto& [key, meaning] : choices) {
    if (key == value) return meaning;
    names += (names.empty() ? "" : ", ") + key;
  }
  fail("--{} {}: must be one of {}", name, value, names);
}

template <class T>
void check_range(const std::string& name, T value, T low, T high) {
  if (!(value >= low && value <= high))
    fail("--{} {}: must be from {} to {}", name, value, low, high);
}

void check_values(const Settings& settings, const Raw& raw) {
  check_range("resolution-level", settings.survey.resolution.level, 0u, 16u);
  check_range("max-resolution", settings.survey.resolution.max, 16, 1 << 16);
  check_range("min-resolution", settings.survey.resolution.min, 1, 1 << 16);
  check_range("sub-resolution-levels", settings.matching.sub_resolution_levels, 0, 8);
  check_range("number-views", settings.number_views, 0u, 32u);
  check_range("iters", settings.matching.iterations, 1, 60);
  check_range("geometric-iters", settings.geometric_iterations, 0, 20);
  check_range("postprocess-dmaps", settings.postprocess, 0u, 7u);
  check_range("number-views-fuse", settings.fusion.min_views, std::size_t{0}, std::size_t{255});
  if (raw.fusion_mode == -2)
    fail("--fusion-mode -2: disparity maps are not built; -1 fuses existing depth maps");
  check_range("fusion-mode", raw.fusion_mode, -1, 1);
  check_range("estimate-colors", settings.estimate_colors, 0u, 2u);
  check_range("estimate-normals", settings.estimate_normals, 0u, 2u);
  if (const double value = raw.estimate_roi; value != 1.1 && value != std::floor(value))
    fail("--estimate-roi {}: must be 0, 1 or 2; 1.1, the default of OpenMVS 2.4, means 2", value);
  check_range("estimate-roi", raw.estimate_roi, 0.0, 2.0);
  check_range("max-memory", settings.survey.memory.megabytes, std::uint64_t{0},
              std::uint64_t{1} << 40);
  io::check_bit_depth(settings.survey.bit_depth, option_of("bit_depth"));
  check_range("roi-border", settings.roi_border, -1e6, 1e6);
  check_range("export-number-views", settings.export_number_views, -255, 255);
  check_range("estimate-scale", settings.estimate_scale, 0.0, 1e6);
  check_range("filter-point-cloud", settings.filter_point_cloud, -(1 << 30), 1 << 30);
  check_range("tower-mode", raw.tower_mode, -4, 4);
}

// Warns of valid options that have no effect.
void warn_of_no_effect(const Settings& settings, const Raw& raw) {
  if (raw.tower_mode != 0)
    log_warning(
        "--tower-mode {}: not built: as with 0, no points are added around a line of cameras",
        raw.tower_mode);
  if (settings.filter_point_cloud > 0)
    log_warning(
        "--filter-point-cloud {}: has no effect, as in OpenMVS: only values below 0 filter, and "
        "they filter only an existing cloud (-p)",
        settings.filter_point_cloud);
}

// The values of the options that are names.
void take_choices(const Raw& raw, Settings& settings) {
  using io::PortChoice;
  settings.survey.files.ports =
      one_of<PortChoice>("camera-model", raw.camera_model,
                         {{"auto", raw.refractive ? PortChoice::required : PortChoice::automatic},
                          {"pinhole", PortChoice::ignored},
                          {"flatport", PortChoice::flat}});
  settings.double_precision =
      one_of<bool>("output-precision", raw.precision, {{"float", false}, {"double", true}});
  settings.projection = one_of<ProjectionMethod>(
      "projection", raw.projection,
      {{"exact", ProjectionMethod::exact}, {"line-search", ProjectionMethod::line_search}});
  settings.matching.warp = one_of<depth::Warp>(
      "warp", raw.warp, {{"affine", depth::Warp::affine}, {"homography", depth::Warp::homography}});
  if (raw.refractive && settings.survey.files.ports == PortChoice::ignored)
    fail("--refractive contradicts --camera-model pinhole");
}

void take_paths(const CommonOptions& common, const Raw& raw, Settings& settings) {
  const auto path = [&](const std::string& given) { return in_working_folder(common, given); };
  settings.survey.files.working_folder = common.working_folder;
  settings.survey.files.scene = path(raw.input);
  settings.output = with_extension(
      output_or(common, raw.output,
                without_known_extension(settings.survey.files.scene) += "_dense", "--output-file"),
      ".mvs");
  refuse_other_format(path(raw.output), "--output-file");
  settings.survey.files.housing = path(raw.housing);
  settings.point_cloud = path(raw.point_cloud);
  settings.neighbour_lists = path(raw.neighbour_lists);
  settings.neighbour_lists_output =
      output_in_working_folder(common, raw.neighbour_lists_output, "--output-view-neighbors-file");
  settings.report = output_in_working_folder(common, raw.report, "--report-file");
  settings.survey.mask_folder = path(raw.mask_path);
  settings.pinhole_export =
      folder_in_working_folder(common, raw.pinhole_export, "--pinhole-export");
  settings.plan = output_in_working_folder(common, raw.plan, "--plan");
}

// From -v 3 on, pictures of the depth maps are written beside them, as by OpenMVS. From -v 5 on,
// pictures of the maps of every stage, too.
densify::Pictures pictures_of(int verbosity) {
  using densify::Pictures;
  if (verbosity < 3) return Pictures::none;
  return verbosity < 5 ? Pictures::final_maps : Pictures::maps_of_every_stage;
}

void check_pinhole_export(const Settings& settings) {
  if (!settings.pinhole_export.empty() &&
      (!settings.fuse || only_exports(settings) || !settings.neighbour_lists_output.empty() ||
       !settings.until.empty() || !settings.plan.empty()))
    fail("--pinhole-export {}: needs a cloud, which this run does not make",
         settings.pinhole_export.string());
}

// A run for one stage or for a plan makes nothing else.
void check_purpose(const Settings& settings) {
  const bool other = only_exports(settings) || !settings.neighbour_lists_output.empty();
  if (!settings.until.empty() && (!settings.make_maps || other))
    fail("--until {}: this run makes no depth maps", settings.until);
  if (!settings.plan.empty() && (!settings.make_maps || other || !settings.until.empty()))
    fail("--plan {}: plans only runs that make all depth maps", settings.plan.string());
}

void take_part(const std::string& part, Settings& settings) {
  if (part.empty()) return;
  constexpr std::size_t kMostParts = 1000000;
  const Fraction fraction = parse_fraction("--part", part, kMostParts);
  settings.part = fraction.part;
  settings.parts = fraction.count;
  if (settings.until.empty()) fail("--part {}: needs --until", part);
}

// Fills the settings from the values of the options.
void convert(const Raw& raw, Options& options) {
  Settings& settings = options.settings;
  const CommonOptions& common = options.parsed.common;
  if (const auto file = in_working_folder(common, raw.dense_config); !file.empty()) {
    apply_dense_config(file, settings);
    settings.other_inputs.push_back(file);
  }
  take_paths(common, raw, settings);
  if (!settings.survey.mask_folder.empty() && !given(options.parsed, "ignore-mask-label"))
    settings.survey.ignore_mask_label = 0;
  take_choices(raw, settings);
  settings.make_maps = raw.fusion_mode >= 0;
  settings.fuse = raw.fusion_mode <= 0;
  take_part(raw.part, settings);
  check_purpose(settings);
  check_pinhole_export(settings);
  settings.region = raw.estimate_roi == 1.1 ? RegionMode::adaptive
                                            : static_cast<RegionMode>(int(raw.estimate_roi));
  settings.fusion.two_if_undisputed = !given(options.parsed, "number-views-fuse");
  settings.pictures = pictures_of(common.verbosity);
  settings.max_threads = common.max_threads;
  settings.survey.files.name_of = option_of;
  take_tiles(raw.tile, options);
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
  Settings& settings = options.settings;
  Raw raw;
  ProgramOptions program = described_program();
  declare_io(program.visible, raw, settings);
  io::declare_bit_depth(program.visible, settings.survey.bit_depth);
  declare_camera(program.visible, raw);
  declare_matching(program.visible, settings);
  declare_parts(program.visible, raw, settings);
  declare_fusion(program.visible, raw, settings);
  declare_points(program.visible, raw, settings);
  UnusedInput::declare(program.visible, settings.survey.files.allow_missing);
  std::vector<NotBuilt> visible = not_built(), hidden = not_built_hidden();
  declare_not_built(program.visible, visible);
  declare_not_built(program.hidden, hidden);
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;

  refuse_not_built(visible);
  refuse_not_built(hidden);
  check_values(settings, raw);
  warn_of_no_effect(settings, raw);
  convert(raw, options);
  warn_of_options_without_effect(options);
  return options;
}

}  // namespace axial::apps
