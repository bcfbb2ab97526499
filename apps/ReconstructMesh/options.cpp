// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <fmt/format.h>

#include <vector>

#include "base/error.h"
#include "base/program/option_values.h"
#include "base/program/output_name.h"
#include "base/version.h"
#include "io/obj/mesh_file.h"
#include "io/openmvs/scene_options.h"

namespace axial::apps {
namespace {

// The values of the command line before they are checked and converted.
struct Raw {
  std::string input, export_type = "ply", tile;
  io::SceneOptions scene;
};

void declare_io(OptionList& list, Raw& raw, Options& options) {
  list.add("input-file,i", &raw.input, "scene with cameras (.mvs)")
      .add("pointcloud-file,p", &options.cloud,
           "dense cloud with views (<input>.ply, or the scene's points if there is no such file)")
      .add("output-file,o", &options.output, "mesh to write (<input>_mesh.ply)")
      .output_file()
      .sets("output")
      .add_with_default("export-type", &raw.export_type,
                        "format of the mesh: ply, obj or glb; if it is not given, the extension of "
                        "--output-file decides")
      .sets("type")
      .add_max_memory(60 * kMegabyte)
      .add_with_default("tiles", &options.tiling.count,
                        "make the mesh in this many parts, so that less memory is needed")
      .range(1, kMostTiles)
      .add("tile", &raw.tile,
           "make only tile I of N tiles (I/N); a run with --tiles N joins the tiles");
}

void declare_reconstruction(OptionList& list, Options& options) {
  mesh::ReconstructOptions& settings = options.reconstruct;
  list.add_with_default("min-point-distance,d", &settings.merge.min_distance,
                        "points that are closer than this in all images that see them [px] are "
                        "merged (0: none)")
      .range(0, 1e3)
      .sets("merge.min_distance")
      .add_with_default("integrate-only-roi", &settings.only_region,
                        "use only points in the region of interest")
      .add_with_default("constant-weight", &settings.votes.constant_weight,
                        "every view of a merged point counts once; otherwise by its points")
      .add_with_default("free-space-support,f", &settings.votes.weak_support,
                        "also reconstruct surfaces that few points support")
      .add_with_default("thickness-factor", &settings.votes.thickness_factor,
                        "multiplies the expected error of the points along their rays")
      .range(1e-3, 1e3)
      .add_with_default("quality-factor", &settings.votes.quality_factor,
                        "multiplies the cost of badly shaped surfaces")
      .range(0, 1e3);
}

void declare_cleaning(OptionList& list, Options& options) {
  mesh::CleanOptions& clean = options.reconstruct.clean;
  list.add_with_default("decimate", &clean.decimate, "part of the faces to keep, from 0 to 1")
      .range(1e-6, 1)
      .add_with_default("target-face-num", &clean.target_faces,
                        "number of faces to keep, instead of --decimate (0: not used)")
      .add_with_default("remove-spurious", &clean.spurious,
                        "remove faces whose longest edge is longer than a third of this many "
                        "median longest edges, where no camera has seen a surface, and pieces "
                        "smaller than this many mean edges (0: none)")
      .range(0, 1e6)
      .add_with_default("remove-spikes", &clean.spikes,
                        "remove faces that hang on the mesh by one edge")
      .add_with_default("close-holes", &clean.close_holes,
                        "close holes of at most this many edges (0: none)")
      .range(0, 1000)
      .add_with_default("close-unseen", &options.close_unseen,
                        "keep surface that no two cameras see, and mark it, instead of removing it "
                        "(with fewer than two cameras it is always kept)")
      .add_with_default("smooth", &clean.smooth, "number of smoothing steps")
      .range(0, 1000)
      .add_with_default("edge-length", &clean.edge_length,
                        "remesh to edges of this length [scene units] (0: no)")
      .range(0, 1e9)
      .add_with_default("roi-border", &options.roi_border,
                        "above 0 multiplies the region's size, below 0 adds to it [scene units]")
      .range(-1e6, 1e6)
      .add_with_default("crop-to-roi", &options.reconstruct.crop_to_region,
                        "crop the mesh to the region of interest, if the scene has one");
  boundary::declare(list, options.boundary);
}

void take_paths(const Raw& raw, Options& options) {
  options.survey.files = io::scene_files(raw.scene, raw.input, options.parsed);
  options.output = io::mesh_file({options.survey.files.scene, options.output, raw.export_type,
                                  given(options.parsed, "export-type"), "_mesh"},
                                 program_context(options.parsed));
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
  Tiling& tiling = options.tiling;
  if (given(options.parsed, "tile")) take_tile(raw.tile, options.parsed, tiling);
  const std::string option = text_of(tiling);
  if (tiling.tile && tiling.count == 1) fail("{}: there must be at least 2 tiles", option);
  if (tiling.count > 1) refuse_other_triangles(option, options);
}

// Warns of valid options that have no effect.
void warn_of_no_effect(const Options& options) {
  if (options.mesh.empty()) return;
  warn_without_effect(
      options.parsed,
      {"pointcloud-file", "min-point-distance", "integrate-only-roi", "constant-weight",
       "free-space-support", "thickness-factor", "quality-factor"},
      "with --mesh-file, which is only cleaned");
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  Raw raw;
  ProgramOptions program{"ReconstructMesh",
                         "reconstructs a mesh from a dense cloud, in air and under water",
                         OptionList("Mesh options"), OptionList("Hidden options")};
  program.version = version_line(program.name);
  declare_io(program.visible, raw, options);
  io::declare_scene_options(program.visible, raw.scene);
  declare_reconstruction(program.visible, options);
  declare_cleaning(program.visible, options);
  program.hidden.add("mesh-file", &options.mesh, "clean this mesh instead of reconstructing");
  program.visible.add_not_built("cuda-device", "-1", {"-1", "-2"});
  program.hidden.add_not_built("mesh-export", "0", {"0", "false", "no", "off"})
      .add_not_built("split-max-area", "0", {"0", "0.0"})
      .add_not_built("import-roi-file", "", {""})
      .add_not_built("image-points-file", "", {""});
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  options.reconstruct.clean.cut_off = options.reconstruct.clean.spurious;
  take_paths(raw, options);
  take_tiles(raw, options);
  boundary::check(options.parsed, options.boundary);
  warn_of_no_effect(options);
  return options;
}

}  // namespace axial::apps
