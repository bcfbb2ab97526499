// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <cmath>
#include <initializer_list>

#include "base/error.h"
#include "base/file_extension.h"
#include "base/log.h"
#include "base/program/option_values.h"
#include "base/program/output_name.h"
#include "base/version.h"
#include "io/openmvs/scene_options.h"
#include "io/textured/textured_mesh.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// The values of the command line before they are converted.
struct Texts {
  std::string input;
  io::SceneOptions cameras;
};

bool is_las(const fs::path& path) {
  return lower_extension(path) == ".las";
}

void declare_files(OptionList& list, Options& options, Texts& texts) {
  list.add("input-file,i", &texts.input,
           "scene to transform (.mvs); or a cloud (.ply), to write it as LAS (.las)")
      .add("pointcloud-file,p", &options.cloud,
           "PLY cloud in the scene's coordinates, transformed with it")
      .add("mesh-file,m", &options.mesh,
           "mesh in the scene's coordinates, transformed with it: PLY, OBJ, GLB or glTF")
      .add("output-file,o", &options.output,
           "scene to write (<input>_transform.mvs); the cloud and the mesh are written beside it, "
           "as .ply and _mesh.ply; for a cloud as input, the file to write (<input>.las)")
      .output_file()
      .add_with_default("export-type", &options.export_type,
                        "format of the mesh that is written: ply, obj, glb or gltf; a mesh that is "
                        "not transformed is written, too, if this option is given")
      .add_with_default("epsg", &options.epsg,
                        "EPSG code of the coordinate reference system that a .las file states, a "
                        "projected one in metres (0: none)")
      .range(0, 1 << 20);
  io::declare_scene_options(list, texts.cameras);
}

void declare_moves(OptionList& list, Options& options) {
  list.add("align-file,a", &options.align,
           "scene (.mvs) whose camera centres give the similarity; images are matched by name, or "
           "by their order if names do not match and the numbers of images agree")
      .add("transform-file,t", &options.transform,
           "text file with 12 or 16 numbers: the similarity as a matrix, row by row, from world to "
           "world coordinates")
      .add("positions", &options.positions,
           "text file with the known positions of camera centres: a line NAME X Y Z for an image, "
           "or a file of Metashape, Pix4D, OpenDroneMap or a spreadsheet")
      .add_switch("rigid", &options.rigid, "align without a change of scale")
      .add_switch("scale-ports", &options.scale_ports,
                  "a change of scale also changes the lengths of the ports that cameras carry. "
                  "Without it such a change is an error behind these ports, because their lengths "
                  "are known in metres")
      .add("transform-out", &options.transform_out,
           "write the transformation to this file, as a 4 x 4 matrix, row by row")
      .output_file();
}

void declare_other_work(OptionList& list, Options& options) {
  list.add_with_default("compute-volume", &options.compute_volume,
                        "1: report the volume of the mesh, after the transformation")
      .add_with_default("plane-threshold", &options.plane_threshold,
                        "distance up to which a part of the mesh lies on the ground plane, above "
                        "which the volume is measured [m] (0: 1/200 of the mesh's diagonal, "
                        "negative: no ground plane, the mesh must be closed)")
      .add_with_default("up-axis", &options.up_axis,
                        "0, 1, 2: the axis from which the ground plane's normal is at most 45 "
                        "degrees away; the cameras are above the plane")
      .range(0, 2)
      .add("sample-mesh", &options.sample_mesh,
           "write random points on the mesh, after the transformation, to <output>_samples.ply: "
           "below 0, minus the number of points; above 0, points for each square unit of area")
      .add_with_default("max-resolution", &options.max_resolution,
                        "shrink images whose longest side is longer [px], into the folder "
                        "images<N> beside the output (0: no limit)")
      .add_not_built("transfer-texture-file", "", {""})
      .add_not_built("indices-file", "", {""});
}

// The options of a run that converts a cloud. A cloud has no cameras, and stays where it is.
void set_cloud(Options& options) {
  for (const char* name : {"pointcloud-file", "mesh-file", "export-type", "refractive", "housing",
                           "camera-model", "allow-missing", "align-file", "transform-file",
                           "positions", "rigid", "scale-ports", "transform-out", "compute-volume",
                           "plane-threshold", "up-axis", "sample-mesh", "max-resolution"})
    if (given(options.parsed, name))
      fail("--{}: is for a scene, and --input-file {} is a cloud", name, options.input.string());
  options.output =
      output_or(options.output, fs::path(options.input).replace_extension(".las"), "--output-file");
  if (!is_las(options.output))
    fail("--output-file {}: a cloud is written as .las alone", options.output.string());
}

void set_paths(const Texts& texts, Options& options) {
  options.input = in_working_folder(options.parsed.common, texts.input);
  if (options.is_cloud()) return set_cloud(options);
  if (is_las(options.output))
    fail("--output-file {}: only a cloud is written as .las: give its .ply as --input-file",
         options.output.string());
  options.survey.files = io::scene_files(texts.cameras, texts.input, options.parsed);
  options.output = with_extension(
      output_or(options.output, without_known_extension(options.survey.files.scene) += "_transform",
                "--output-file"),
      ".mvs");
}

void check_mesh_outputs(Options& options) {
  const std::string given_type = options.export_type;
  options.export_type = lower_case(given_type);
  if (!io::textured_format(options.export_type))
    fail("--export-type {}: must be one of ply, obj, glb, gltf", given_type);
  options.converts = given(options.parsed, "export-type");
}

// Scripts for OpenMVS may state its default, which has no effect there without a mesh.
void check_samples(Options& options) {
  constexpr double kDefaultOfOpenMvs = -300000;
  if (!std::isfinite(options.sample_mesh))
    fail("--sample-mesh is {}: must be a number", options.sample_mesh);
  if (options.sample_mesh == 0 || !options.mesh.empty()) return;
  if (options.sample_mesh != kDefaultOfOpenMvs || !options.writes_scene())
    fail("--sample-mesh needs --mesh-file: the mesh on which points are written");
  log_warning("--sample-mesh {}: without effect without --mesh-file", options.sample_mesh);
  options.sample_mesh = 0;
}

void check(const Options& options) {
  const int ways = !options.align.empty() + !options.transform.empty() + !options.positions.empty();
  if (ways > 1) fail("--align-file, --transform-file, --positions: only one can be given");
  if (!options.writes_scene() && !options.writes_mesh() && !options.compute_volume &&
      options.sample_mesh == 0)
    fail(
        "nothing to do: give --align-file, --transform-file, --positions, --max-resolution, "
        "--sample-mesh, --compute-volume 1, or --mesh-file and --export-type");
  if (options.compute_volume && options.mesh.empty())
    fail("--compute-volume needs --mesh-file: the mesh whose volume is measured");
  if (!options.cloud.empty() && options.cloud.extension() != ".ply")
    fail_in(options.cloud, "not built yet: clouds are read from PLY files alone");
  const std::string kind = lower_extension(options.mesh);
  if (!options.mesh.empty() && kind != ".ply" && kind != ".obj" && kind != ".glb" &&
      kind != ".gltf")
    fail_in(options.mesh, "not built yet: meshes are read from PLY, OBJ, GLB and glTF files");
  if (!std::isfinite(options.plane_threshold))
    fail("--plane-threshold is {}: must be a length in metres", options.plane_threshold);
}

void warn_of_no_effect(const Options& options) {
  const auto warn = [&](bool without_effect, std::initializer_list<const char*> names,
                        const char* cause) {
    if (without_effect) warn_without_effect(options.parsed, names, cause);
  };
  warn(options.align.empty() && options.positions.empty(), {"rigid"},
       "without --align-file or --positions");
  warn(!options.moves(), {"scale-ports", "transform-out"}, "without a transformation");
  warn(options.mesh.empty(), {"export-type"}, "without --mesh-file");
  warn(true, {"epsg"}, "without a cloud as --input-file");
  warn(!options.compute_volume, {"plane-threshold", "up-axis"}, "without --compute-volume 1");
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  Texts texts;
  ProgramOptions program{"TransformScene",
                         "moves a scene, its cloud and its mesh by a similarity, and measures "
                         "volumes",
                         {},
                         {}};
  program.version = version_line(program.name);
  declare_files(program.visible, options, texts);
  declare_moves(program.visible, options);
  declare_other_work(program.visible, options);
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  set_paths(texts, options);
  if (options.is_cloud()) return options;
  check_mesh_outputs(options);
  check_samples(options);
  check(options);
  warn_of_no_effect(options);
  return options;
}

}  // namespace axial::apps
