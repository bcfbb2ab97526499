// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <fmt/format.h>

#include <vector>

#include "base/error.h"
#include "base/fraction.h"
#include "base/log.h"
#include "base/not_built.h"
#include "base/output_name.h"
#include "base/setting_names.h"
#include "base/version.h"
#include "io/obj/mesh_file.h"
#include "io/openmvs/scene_options.h"

namespace axial::apps {
namespace {

// The values of the command line before they are checked and converted.
struct Raw {
  std::string input, output, cloud, mesh, export_type = "ply", tile;
  io::SceneOptions scene;
};

constexpr SettingName kOptions[] = {{"max_memory", "--max-memory"},
                                    {"merge.min_distance", "--min-point-distance"},
                                    {"output", "--output-file"},
                                    {"tiles", "--tiles"},
                                    {"type", "--export-type"}};

std::string option_of(std::string_view setting) {
  return name_in(kOptions, setting);
}

std::vector<NotBuilt> not_built() {
  return {{"cuda-device", "-1", {"-1", "-2"}}};
}

std::vector<NotBuilt> not_built_hidden() {
  return {{"mesh-export", "0", {"0", "false", "no", "off"}},
          {"split-max-area", "0", {"0", "0.0"}},
          {"import-roi-file", "", {""}},
          {"image-points-file", "", {""}}};
}

void declare_io(OptionList& list, Raw& raw, Options& options) {
  list.add("input-file,i", &raw.input, "scene with cameras (.mvs)")
      .add("pointcloud-file,p", &raw.cloud,
           "dense cloud with views (<input>.ply, or the scene's points if there is no such file)")
      .add("output-file,o", &raw.output, "mesh to write (<input>_mesh.ply)")
      .add_with_default("export-type", &raw.export_type,
                        "format of the mesh: ply, obj or glb; if it is not given, the extension of "
                        "--output-file decides")
      .add_with_default("max-memory", &options.survey.memory.megabytes,
                        "largest memory to use [MB] (0: 70 % of the free memory)")
      .add_with_default("tiles", &options.tiles,
                        "make the mesh in this many parts, so that less memory is needed")
      .add("tile", &raw.tile,
           "make only tile I of N tiles (I/N); a run with --tiles N joins the tiles");
}

void declare_reconstruction(OptionList& list, Options& options) {
  mesh::ReconstructOptions& settings = options.reconstruct;
  list.add_with_default("min-point-distance,d", &settings.merge.min_distance,
                        "points that are closer than this in all images that see them [px] are "
                        "merged (0: none)")
      .add_with_default("integrate-only-roi", &settings.only_region,
                        "use only points in the region of interest")
      .add_with_default("constant-weight", &settings.votes.constant_weight,
                        "every view of a merged point counts once; otherwise by its points")
      .add_with_default("free-space-support,f", &settings.votes.weak_support,
                        "also reconstruct surfaces that few points support")
      .add_with_default("thickness-factor", &settings.votes.thickness_factor,
                        "multiplies the expected error of the points along their rays")
      .add_with_default("quality-factor", &settings.votes.quality_factor,
                        "multiplies the cost of badly shaped surfaces");
}

void declare_cleaning(OptionList& list, Options& options) {
  mesh::CleanOptions& clean = options.reconstruct.clean;
  list.add_with_default("decimate", &clean.decimate, "part of the faces to keep, from 0 to 1")
      .add_with_default("target-face-num", &clean.target_faces,
                        "number of faces to keep, instead of --decimate (0: not used)")
      .add_with_default("remove-spurious", &clean.spurious,
                        "remove faces whose longest edge is longer than a third of this many "
                        "median longest edges, where no camera has seen a surface, and pieces "
                        "smaller than this many mean edges (0: none)")
      .add_with_default("remove-spikes", &clean.spikes,
                        "remove faces that hang on the mesh by one edge")
      .add_with_default("close-holes", &clean.close_holes,
                        "close holes of at most this many edges (0: none)")
      .add_with_default("close-unseen", &options.close_unseen,
                        "keep surface that no two cameras see, and mark it, instead of removing it "
                        "(with fewer than two cameras it is always kept)")
      .add_with_default("smooth", &clean.smooth, "number of smoothing steps")
      .add_with_default("edge-length", &clean.edge_length,
                        "remesh to edges of this length [scene units] (0: no)")
      .add_with_default("roi-border", &options.roi_border,
                        "above 0 multiplies the region's size, below 0 adds to it [scene units]")
      .add_with_default("crop-to-roi", &options.reconstruct.crop_to_region,
                        "crop the mesh to the region of interest, if the scene has one");
}

template <class T>
void check_range(const std::string& name, T value, T low, T high) {
  if (!(value >= low && value <= high))
    fail("--{} {}: must be from {} to {}", name, value, low, high);
}

void check_values(const Options& options) {
  const mesh::ReconstructOptions& settings = options.reconstruct;
  check_range("min-point-distance", settings.merge.min_distance, 0.0, 1e3);
  check_range("thickness-factor", settings.votes.thickness_factor, 1e-3, 1e3);
  check_range("quality-factor", settings.votes.quality_factor, 0.0, 1e3);
  check_range("decimate", settings.clean.decimate, 1e-6, 1.0);
  check_range("remove-spurious", settings.clean.spurious, 0.0, 1e6);
  check_range("close-holes", settings.clean.close_holes, std::size_t{0}, std::size_t{1000});
  check_range("smooth", settings.clean.smooth, 0u, 1000u);
  check_range("edge-length", settings.clean.edge_length, 0.0, 1e9);
  check_range("roi-border", options.roi_border, -1e6, 1e6);
  check_range("max-memory", options.survey.memory.megabytes, std::uint64_t{0},
              std::uint64_t{1} << 40);
}

void take_paths(const Raw& raw, Options& options) {
  const CommonOptions& common = options.parsed.common;
  options.survey.files = io::scene_files(raw.scene, raw.input, common);
  options.cloud = in_working_folder(common, raw.cloud);
  options.mesh = in_working_folder(common, raw.mesh);
  options.output = io::mesh_file(
      {options.survey.files.scene, output_in_working_folder(common, raw.output, "--output-file"),
       raw.export_type, given(options.parsed, "export-type"), "_mesh", option_of});
  refuse_control_characters(options.output, "--output-file");
}

// A tile has neighbours whose triangles must be the same.
void refuse_other_triangles(const std::string& option, const Options& options) {
  for (const char* name : {"decimate", "target-face-num", "edge-length"})
    if (given(options.parsed, name))
      fail("{}: contradicts --{}; give --{} with --mesh-file for the joined mesh", option, name,
           name);
  if (!options.mesh.empty()) fail("{}: contradicts --mesh-file", option);
}

void take_tiles(const Raw& raw, Options& options) {
  check_range("tiles", options.tiles, std::size_t{1}, kMostTiles);
  std::string option = fmt::format("--tiles {}", options.tiles);
  if (given(options.parsed, "tile")) {
    const Fraction fraction = parse_fraction("--tile", raw.tile, kMostTiles);
    option = "--tile " + raw.tile;
    if (fraction.count == 1) fail("{}: there must be at least 2 tiles", option);
    if (given(options.parsed, "tiles") && options.tiles != fraction.count)
      fail("{}: contradicts --tiles {}", option, options.tiles);
    options.tile = fraction.part;
    options.tiles = fraction.count;
  }
  if (options.tiles > 1 || options.tile > 0) refuse_other_triangles(option, options);
}

// Warns of valid options that have no effect.
void warn_of_no_effect(const Options& options) {
  if (options.mesh.empty()) return;
  for (const char* name :
       {"pointcloud-file", "min-point-distance", "integrate-only-roi", "constant-weight",
        "free-space-support", "thickness-factor", "quality-factor"})
    if (given(options.parsed, name))
      log_warning("--{}: without effect with --mesh-file, which is only cleaned", name);
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  options.survey.memory = {0, "--max-memory", 60 * kMegabyte};
  Raw raw;
  ProgramOptions program{"ReconstructMesh",
                         "reconstructs a mesh from a dense cloud, in air and under water",
                         OptionList("Mesh options"), OptionList("Hidden options")};
  program.version = version_line(program.name);
  declare_io(program.visible, raw, options);
  io::declare_scene_options(program.visible, raw.scene);
  declare_reconstruction(program.visible, options);
  declare_cleaning(program.visible, options);
  program.hidden.add("mesh-file", &raw.mesh, "clean this mesh instead of reconstructing");
  std::vector<NotBuilt> visible = not_built(), hidden = not_built_hidden();
  declare_not_built(program.visible, visible);
  declare_not_built(program.hidden, hidden);
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  refuse_not_built(visible);
  refuse_not_built(hidden);
  check_values(options);
  options.reconstruct.clean.cut_off = options.reconstruct.clean.spurious;
  take_paths(raw, options);
  take_tiles(raw, options);
  options.reconstruct.name_of = option_of;
  warn_of_no_effect(options);
  return options;
}

}  // namespace axial::apps
