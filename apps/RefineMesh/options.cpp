// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "base/not_built.h"
#include "base/output_name.h"
#include "base/setting_names.h"
#include "base/version.h"
#include "io/images/bit_depth.h"
#include "io/obj/mesh_file.h"
#include "io/openmvs/scene_files.h"
#include "io/openmvs/scene_options.h"

namespace axial::apps {
namespace {

// The values of the command line before they are checked and converted.
struct Raw {
  std::string input, mesh, output, mask_path, export_type = "ply";
  io::SceneOptions cameras;
  unsigned alternate_pair = 0;
  double decimate = 0;
  unsigned close_holes = 30;
  double regularity_weight = 0.2;
};

// OpenMVS's options that control steps which this method does not have.
struct WithoutEffect {
  unsigned ensure_edge_size = 1;
  double rigidity_elasticity_ratio = 0.9, gradient_step = 45.05, planar_vertex_ratio = 0;
  bool reduce_memory = true;
};

constexpr SettingName kOptions[] = {
    {"max_memory", "--max-memory"}, {"output", "--output-file"}, {"type", "--export-type"}};

std::string option_of(std::string_view setting) {
  return name_in(kOptions, setting);
}

void declare_io(OptionList& list, Raw& raw, Options& options) {
  survey::Options& survey = options.survey;
  list.add("input-file,i", &raw.input, "scene with cameras (.mvs)")
      .add("mesh-file,m", &raw.mesh, "mesh to refine: PLY, OBJ, GLB or glTF (<input>.ply)")
      .add("output-file,o", &raw.output, "mesh to write (<input>_refine.ply)")
      .add_with_default("export-type", &raw.export_type,
                        "format of the mesh: ply, obj or glb; if it is not given, the extension of "
                        "--output-file decides")
      .add_with_default("max-memory", &survey.memory.megabytes,
                        "largest memory to use [MB] (0: 70 % of the free memory)")
      .add("mask-path", &raw.mask_path,
           "folder with a mask for every image: a.mask.png, a.jpg.png, a_mask.png or a.png for "
           "a.jpg, in the same subfolders as the images")
      .add_with_default("ignore-mask-label", &survey.ignore_mask_label,
                        "mask value to leave out; below 0: no masks (default with --mask-path: 0)");
  io::declare_bit_depth(list, survey.bit_depth);
}

void declare_refinement(OptionList& list, Raw& raw, Options& options) {
  list.add_with_default("resolution-level", &options.survey.resolution.level,
                        "number of times that the images are halved first")
      .add_with_default("min-resolution", &options.survey.resolution.min,
                        "images are not halved below this length of the longer side [px]")
      .add_with_default("max-views", &options.refine.max_views,
                        "number of views with which a view is compared")
      .add_with_default("decimate", &raw.decimate,
                        "part of the faces to keep before refining, from 0 to 1 (0: all)")
      .add_with_default("close-holes", &raw.close_holes,
                        "close holes of at most this many edges (0: none)")
      .add_with_default("close-unseen", &options.close_unseen,
                        "keep surface that no two cameras see, and mark it, instead of removing it "
                        "(a mesh with marks is always kept)")
      .add_with_default("max-face-area", &options.refine.max_face_area,
                        "faces are split until none is larger than this in two images [px^2] (0: "
                        "no face is split)")
      .add_with_default("scales", &options.refine.scales,
                        "number of resolutions, from coarse to fine")
      .add_with_default("scale-step", &options.refine.scale_step,
                        "size of the images relative to the next finer resolution")
      .add_with_default("alternate-pair", &raw.alternate_pair,
                        "reference of a pair of images: 0 each of them, 1 by turns, 2 the first "
                        "one, 3 the second one")
      .add_with_default("regularity-weight", &raw.regularity_weight,
                        "weight of the smoothness of the surface");
}

void declare_without_effect(OptionList& list, WithoutEffect& raw) {
  const char* text = "accepted for scripts: without effect";
  list.add_with_default("ensure-edge-size", &raw.ensure_edge_size, text)
      .add_with_default("rigidity-elasticity-ratio", &raw.rigidity_elasticity_ratio, text)
      .add_with_default("gradient-step", &raw.gradient_step, text)
      .add_with_default("planar-vertex-ratio", &raw.planar_vertex_ratio, text)
      .add_with_default("reduce-memory", &raw.reduce_memory, text);
}

void warn_of_no_effect(const Options& options) {
  std::string names;
  for (const char* name : {"ensure-edge-size", "rigidity-elasticity-ratio", "gradient-step",
                           "planar-vertex-ratio", "reduce-memory"})
    if (given(options.parsed, name)) names += (names.empty() ? "--" : ", --") + std::string(name);
  if (!names.empty())
    log_warning("{}: without effect: the mesh is refined by Gauss-Newton steps", names);
}

template <class T>
void check_range(const std::string& name, T value, T low, T high) {
  if (!(value >= low && value <= high))
    fail("--{} {}: must be from {} to {}", name, value, low, high);
}

void check_values(const Options& options, const Raw& raw) {
  check_range("resolution-level", options.survey.resolution.level, 0u, 16u);
  check_range("min-resolution", options.survey.resolution.min, 1, 1 << 16);
  check_range("max-views", options.refine.max_views, 1u, 1000u);
  check_range("decimate", raw.decimate, 0.0, 1.0);
  check_range("max-face-area", options.refine.max_face_area, 0.0, 1e9);
  check_range("scales", options.refine.scales, 1u, 16u);
  check_range("scale-step", options.refine.scale_step, 0.1, 1.0);
  check_range("alternate-pair", raw.alternate_pair, 0u, 3u);
  check_range("regularity-weight", raw.regularity_weight, 0.0, 1e6);
  check_range("max-memory", options.survey.memory.megabytes, std::uint64_t{0},
              std::uint64_t{1} << 40);
  io::check_bit_depth(options.survey.bit_depth, "--bit-depth");
}

void take_paths(const Raw& raw, Options& options) {
  const CommonOptions& common = options.parsed.common;
  survey::Options& survey = options.survey;
  survey.files = io::scene_files(raw.cameras, raw.input, common);
  survey.mask_folder = in_working_folder(common, raw.mask_path);
  if (!survey.mask_folder.empty() && !given(options.parsed, "ignore-mask-label"))
    survey.ignore_mask_label = 0;
  survey.compares_photographs = true;
  options.mesh = in_working_folder(common, raw.mesh);
  if (options.mesh.empty()) options.mesh = io::cloud_beside(survey.files.scene);
  options.output = io::mesh_file(
      {survey.files.scene, output_in_working_folder(common, raw.output, "--output-file"),
       raw.export_type, given(options.parsed, "export-type"), "_refine", option_of});
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
  options.refine.name_of = option_of;
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  options.survey.memory.setting = "--max-memory";
  options.survey.resolution = {0, 640, 1 << 16};
  Raw raw;
  WithoutEffect without_effect;
  ProgramOptions program{"RefineMesh",
                         "moves the vertices of a mesh until its photographs agree with each "
                         "other, in air and under water",
                         OptionList("Refine options"), OptionList("Hidden options")};
  program.version = version_line(program.name);
  declare_io(program.visible, raw, options);
  io::declare_scene_options(program.visible, raw.cameras);
  declare_refinement(program.visible, raw, options);
  declare_without_effect(program.visible, without_effect);
  std::vector<NotBuilt> not_built{{"cuda-device", "-1", {"-1", "-2"}}};
  declare_not_built(program.visible, not_built);
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  refuse_not_built(not_built);
  check_values(options, raw);
  convert(raw, options);
  warn_of_no_effect(options);
  return options;
}

}  // namespace axial::apps
