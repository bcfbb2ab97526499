// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <string>

#include "base/error.h"
#include "base/output_name.h"
#include "base/version.h"
#include "io/images/bit_depth.h"
#include "io/openmvs/scene_files.h"
#include "io/openmvs/scene_options.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// The values of the command line before they are checked and converted.
struct Raw {
  std::string input, cloud, mesh, report, maps, changes, depth_maps, run, sfm_model, truth;
  io::SceneOptions scene;
};

void declare_survey(OptionList& list, Raw& raw, Options& options) {
  list.add("map", &raw.maps, "maps to show: the begin of their names, -o of MapSurface")
      .add("change", &raw.changes,
           "changes to show: the begin of the names of their files, -o of CompareSurveys")
      .add_with_default("map-size", &options.maps.longest_side,
                        "longest side of the maps in the folder [px]")
      .add("depth-maps", &raw.depth_maps,
           "folder of the depth maps (.dmap) to show (that of the scene)")
      .add_with_default("depth-map-size", &options.depth_maps.longest_side,
                        "longest side of the pictures of depth maps in the folder [px]; 0: no "
                        "depth maps")
      .add("run", &raw.run, "file with the steps of a run to show, which reconstruct writes");
}

void take_survey(const Raw& raw, const CommonOptions& common, Options& options) {
  options.maps.maps = in_working_folder(common, raw.maps).string();
  options.maps.changes = in_working_folder(common, raw.changes).string();
  options.depth_maps.is_given = !raw.depth_maps.empty();
  options.depth_maps.folder = options.depth_maps.is_given
                                  ? in_working_folder(common, raw.depth_maps)
                                  : options.survey.files.scene.parent_path();
  options.run = in_working_folder(common, raw.run);
}

void declare(OptionList& list, Raw& raw, Options& options) {
  list.add("input-file,i", &raw.input, "scene with cameras and images (.mvs)")
      .add("pointcloud-file,p", &raw.cloud,
           "cloud to show, PLY (<input>.ply; not needed with a mesh)")
      .add("mesh-file,m", &raw.mesh, "mesh to show, with or without textures: PLY, OBJ, GLB, glTF")
      .add("report", &raw.report, "folder to write; a browser shows its index.html")
      .add("sfm-model", &raw.sfm_model,
           "COLMAP model from which the scene was made: the page shows its reprojection errors")
      .add("truth", &raw.truth,
           "true mesh in the scene's coordinates: the page shows the cloud's distances to it")
      .add_with_default("max-points", &options.max_points,
                        "largest number of points; a larger cloud is thinned out randomly")
      .add_with_default("photograph-size", &options.survey.resolution.max,
                        "longest side of the photographs in the folder [px]")
      .add_with_default("texture-size", &options.texture_size,
                        "longest side of the textures in the folder [px]");
  declare_survey(list, raw, options);
  io::declare_bit_depth(list, options.survey.bit_depth);
  io::declare_scene_options(list, raw.scene);
}

// The cloud that is given, or the one beside the scene. Without it, a mesh can be shown alone.
fs::path cloud_to_show(const Raw& raw, const Options& options) {
  if (!raw.cloud.empty()) return in_working_folder(options.parsed.common, raw.cloud);
  const fs::path beside = io::cloud_beside(options.survey.files.scene);
  std::error_code error;
  const bool alone = !options.mesh.empty() && !fs::exists(beside, error);
  return alone ? fs::path() : beside;
}

template <class T>
void check_range(const char* name, T value, T low, T high) {
  if (!(value >= low && value <= high))
    fail("--{} {}: must be from {} to {}", name, value, low, high);
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
  const CommonOptions& common = options.parsed.common;
  if (raw.report.empty()) fail("--report: give the folder to write");
  check_range("max-points", options.max_points, std::uint64_t{1}, std::uint64_t{1} << 30);
  check_range("photograph-size", options.survey.resolution.max, 16, 1 << 16);
  check_range("texture-size", options.texture_size, 16, 1 << 15);
  check_range("map-size", options.maps.longest_side, 16, 1 << 14);
  if (options.depth_maps.longest_side != 0)
    check_range("depth-map-size", options.depth_maps.longest_side, 16, 1 << 14);
  io::check_bit_depth(options.survey.bit_depth, "--bit-depth");
  options.survey.has_memory_limit = options.survey.has_masks = false;
  options.survey.compares_photographs = true;
  options.survey.files = io::scene_files(raw.scene, raw.input, common);
  options.mesh = in_working_folder(common, raw.mesh);
  options.cloud = cloud_to_show(raw, options);
  if (options.cloud.empty() && !raw.truth.empty())
    fail("--truth {}: its distances are those of a cloud (-p), but only a mesh is shown",
         raw.truth);
  take_survey(raw, common, options);
  options.sfm_model = in_working_folder(common, raw.sfm_model);
  options.truth = in_working_folder(common, raw.truth);
  options.report = folder_in_working_folder(common, raw.report, "--report");
  if (!options.report.has_filename()) options.report = options.report.parent_path();
  return options;
}

}  // namespace axial::apps
