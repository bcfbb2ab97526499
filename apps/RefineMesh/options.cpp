// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include "base/program/output_name.h"
#include "base/version.h"
#include "io/images/bit_depth.h"
#include "io/obj/mesh_file.h"
#include "io/openmvs/scene_files.h"
#include "io/openmvs/scene_options.h"

namespace axial::apps {
namespace {

// The values of the command line before they are checked and converted.
struct Raw {
  std::string input, export_type = "ply";
  io::SceneOptions cameras;
  unsigned alternate_pair = 0;
  double decimate = 0;
  unsigned close_holes = 30;
  double regularity_weight = 0.2;
};

void declare_io(OptionList& list, Raw& raw, Options& options) {
  survey::Options& survey = options.survey;
  list.add("input-file,i", &raw.input, "scene with cameras (.mvs)")
      .add("mesh-file,m", &options.mesh, "mesh to refine: PLY, OBJ, GLB or glTF (<input>.ply)")
      .add("output-file,o", &options.output, "mesh to write (<input>_refine.ply)")
      .output_file()
      .sets("output")
      .add_with_default("export-type", &raw.export_type,
                        "format of the mesh: ply, obj or glb; if it is not given, the extension of "
                        "--output-file decides")
      .sets("type")
      .add_max_memory()
      .add("mask-path", &survey.mask_folder,
           "folder with a mask for every image: a.mask.png, a.jpg.png, a_mask.png or a.png for "
           "a.jpg, in the same subfolders as the images")
      .sets("mask_folder")
      .add_with_default("ignore-mask-label", &survey.ignore_mask_label,
                        "mask value to leave out; below 0: no masks (default with --mask-path: 0)");
  io::declare_bit_depth(list, survey.bit_depth);
  list.add("colors", &survey.color_folder,
           "folder of RestoreColors: its photographs are compared, in the place of the scene's: "
           "they show more in hazy water")
      .sets("color_folder");
}

void declare_refinement(OptionList& list, Raw& raw, Options& options) {
  list.add_with_default("resolution-level", &options.survey.resolution.level,
                        "number of times that the images are halved first")
      .range(0, 16)
      .add_with_default("min-resolution", &options.survey.resolution.min,
                        "images are not halved below this length of the longer side [px]")
      .range(1, 1 << 16)
      .add_with_default("max-views", &options.refine.max_views,
                        "number of views with which a view is compared")
      .range(1, 1000)
      .add_with_default("decimate", &raw.decimate,
                        "part of the faces to keep before refining, from 0 to 1 (0: all)")
      .range(0, 1)
      .add_with_default("close-holes", &raw.close_holes,
                        "close holes of at most this many edges (0: none)")
      .add_with_default("close-unseen", &options.close_unseen,
                        "keep surface that no two cameras see, and mark it, instead of removing it "
                        "(a mesh with marks is always kept)")
      .add_with_default("max-face-area", &options.refine.max_face_area,
                        "faces are split until none is larger than this in two images [px^2] (0: "
                        "no face is split)")
      .range(0, 1e9)
      .add_with_default("scales", &options.refine.scales,
                        "number of resolutions, from coarse to fine")
      .range(1, 16)
      .add_with_default("scale-step", &options.refine.scale_step,
                        "size of the images relative to the next finer resolution")
      .range(0.1, 1)
      .add_with_default("alternate-pair", &raw.alternate_pair,
                        "reference of a pair of images: 0 each of them, 1 by turns, 2 the first "
                        "one, 3 the second one")
      .range(0, 3)
      .add_with_default("regularity-weight", &raw.regularity_weight,
                        "weight of the smoothness of the surface")
      .range(0, 1e6);
}

// OpenMVS's options that control steps which this method does not have.
void declare_without_effect(OptionList& list) {
  const char* help = "accepted for scripts: without effect";
  const char* cause = "the mesh is refined by Gauss-Newton steps";
  list.add_without_effect("ensure-edge-size", 1u, help, cause)
      .add_without_effect("rigidity-elasticity-ratio", 0.9, help, cause)
      .add_without_effect("gradient-step", 45.05, help, cause)
      .add_without_effect("planar-vertex-ratio", 0.0, help, cause)
      .add_without_effect("reduce-memory", true, help, cause);
}

void take_paths(const Raw& raw, Options& options) {
  survey::Options& survey = options.survey;
  survey.files = io::scene_files(raw.cameras, raw.input, options.parsed);
  if (!survey.mask_folder.empty() && !given(options.parsed, "ignore-mask-label"))
    survey.ignore_mask_label = 0;
  survey.compares_photographs = true;
  if (options.mesh.empty()) options.mesh = io::cloud_beside(survey.files.scene);
  options.output = io::mesh_file({survey.files.scene, options.output, raw.export_type,
                                  given(options.parsed, "export-type"), "_refine"},
                                 program_context(options.parsed));
  refuse_control_characters(options.output, "--output-file");
}

void convert(const Raw& raw, Options& options) {
  take_paths(raw, options);
  if (raw.decimate > 0) options.decimate = raw.decimate;
  options.cleaning.close_holes = raw.close_holes;
  options.cleaning.spurious = 0;
  options.cleaning.spikes = false;
  options.refine.references = static_cast<refine::References>(raw.alternate_pair);
  options.refine.smoothness *= raw.regularity_weight / Raw{}.regularity_weight;
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  options.survey.resolution = {0, 640, 1 << 16};
  Raw raw;
  ProgramOptions program{"RefineMesh",
                         "moves the vertices of a mesh until its photographs agree with each "
                         "other, in air and under water",
                         OptionList("Refine options"), OptionList("Hidden options")};
  program.version = version_line(program.name);
  declare_io(program.visible, raw, options);
  io::declare_scene_options(program.visible, raw.cameras);
  declare_refinement(program.visible, raw, options);
  declare_without_effect(program.visible);
  program.visible.add_not_built("cuda-device", "-1", {"-1", "-2"});
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  convert(raw, options);
  return options;
}

}  // namespace axial::apps
