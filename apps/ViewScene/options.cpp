// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <string>

#include "base/error.h"
#include "base/version.h"
#include "io/images/bit_depth.h"
#include "io/openmvs/scene_files.h"
#include "io/openmvs/scene_options.h"
#include "survey/photograph_options.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// The values of the command line before they are checked and converted.
struct Raw {
  std::string input;
  io::SceneOptions scene;
};

void declare_survey(OptionList& list, Options& options) {
  list.add("map", &options.maps.maps, "maps to show: the begin of their names, -o of MapSurface")
      .add("raw-map", &options.maps.raw,
           "a map with the colours of the photographs, if those of --map have no water: the page "
           "shows its orthomosaic")
      .add("earlier-map", &options.maps.earlier,
           "a map of an earlier survey with the same axes, or with those of --change: the page "
           "shows its orthomosaic")
      .add("change", &options.maps.changes,
           "changes to show: the begin of the names of their files, -o of CompareSurveys")
      .add_with_default("map-size", &options.maps.longest_side,
                        "longest side of the maps in the folder [px]")
      .range(16, 1 << 14)
      .add("depth-maps", &options.depth_maps.folder,
           "folder of the depth maps (.dmap) to show (that of the scene)")
      .add_with_default("depth-map-size", &options.depth_maps.longest_side,
                        "longest side of the pictures of depth maps in the folder [px]; 0: no "
                        "depth maps")
      .zero_or(16, 1 << 14)
      .add("run", &options.run, "file with the steps of a run to show, which reconstruct writes");
}

void declare(OptionList& list, Raw& raw, Options& options) {
  list.add("input-file,i", &raw.input, "scene with cameras and images (.mvs)")
      .add("pointcloud-file,p", &options.cloud,
           "cloud to show, PLY (<input>.ply; not needed with a mesh)")
      .add("mesh-file,m", &options.mesh,
           "mesh to show, with or without textures: PLY, OBJ, GLB, glTF")
      .add("report", &options.report, "folder to write; a browser shows its index.html")
      .output_folder()
      .required("the folder to write")
      .add("sfm-model", &options.sfm_model,
           "COLMAP model from which the scene was made: the page shows its reprojection errors")
      .add("truth", &options.truth,
           "true mesh in the scene's coordinates: the page shows the cloud's distances to it")
      .add_with_default("max-points", &options.max_points,
                        "largest number of points; a larger cloud is thinned out randomly")
      .range(1, 1 << 30)
      .add_with_default("photograph-size", &options.survey.resolution.max,
                        "longest side of the photographs in the folder [px]")
      .range(16, 1 << 16)
      .add_with_default("texture-size", &options.texture_size,
                        "longest side of the textures in the folder [px]")
      .range(16, 1 << 15);
  declare_survey(list, options);
  io::declare_bit_depth(list, options.survey.bit_depth);
  survey::declare_colors(list, options.survey);
  io::declare_scene_options(list, raw.scene);
}

// The cloud beside the scene. Without it, a mesh can be shown alone.
fs::path cloud_beside(const Options& options) {
  const fs::path beside = io::cloud_beside(options.survey.files.scene);
  std::error_code error;
  const bool alone = !options.mesh.empty() && !fs::exists(beside, error);
  return alone ? fs::path() : beside;
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  options.survey.resolution = {0, 1, 1024};
  Raw raw;
  ProgramOptions program{
      "ViewScene", "writes a folder for the browser, to look at a reconstruction and measure on it",
      OptionList("View options")};
  program.version = version_line(program.name);
  declare(program.visible, raw, options);
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  options.survey.has_masks = false;
  options.survey.compares_photographs = true;
  options.survey.files = io::scene_files(raw.scene, raw.input, options.parsed);
  if (options.cloud.empty()) options.cloud = cloud_beside(options);
  if (options.cloud.empty() && !options.truth.empty())
    fail("--truth {}: its distances are those of a cloud (-p), but only a mesh is shown",
         options.truth.string());
  options.depth_maps.is_given = !options.depth_maps.folder.empty();
  if (!options.depth_maps.is_given)
    options.depth_maps.folder = options.survey.files.scene.parent_path();
  if (!options.report.has_filename()) options.report = options.report.parent_path();
  return options;
}

}  // namespace axial::apps
