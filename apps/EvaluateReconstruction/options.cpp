// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <initializer_list>
#include <string_view>

#include "base/error.h"
#include "base/log.h"
#include "base/parse_number.h"
#include "base/program/option_values.h"
#include "base/program/unused_input.h"
#include "base/split.h"
#include "base/version.h"

namespace axial::apps {
namespace {

std::vector<double> parse_tolerances(const std::string& text) {
  const std::string wanted = "must be positive lengths in metres, separated by commas";
  if (text.empty()) fail("--tolerance is empty: {}", wanted);
  std::vector<double> values;
  for (const std::string_view word : split(text, ',')) {
    const auto value = parse_finite<double>(word);
    if (!value || !(*value > 0)) fail("--tolerance {}: {}", text, wanted);
    values.push_back(*value);
  }
  return values;
}

std::vector<std::string> names_of(const std::string& list) {
  std::vector<std::string> names;
  for (const std::string_view name : split(list, ',')) {
    if (name.empty()) fail("--render {}: must be names of images, separated by commas", list);
    names.emplace_back(name);
  }
  return names;
}

void declare_inputs(OptionList& visible, Options& options) {
  visible
      .add("input-file,i", &options.input,
           "file to evaluate: a cloud (.ply), a mesh, with or without textures (.ply, .obj, .glb, "
           ".gltf), or a depth map (.dmap)")
      .add("truth-file,m", &options.truth,
           "ground truth: a mesh (.ply, .obj, .glb, .gltf), or for a depth map the distances along "
           "its rays (.tiff); "
           "not needed for --render")
      .add_text_with_default(
          "tolerance", "0.005",
          [&](const std::string& text) { options.tolerances = parse_tolerances(text); },
          "tolerances: largest distances that count as correct [m], separated by "
          "commas; histograms end at 4 times the first tolerance, colours at 2 times")
      .add_with_default("align", &options.align,
                        "none; centres: similarity from the camera centres of --estimated to the "
                        "camera centres of --cameras; icp: rigid refinement on the true mesh")
      .one_of({"none", "centres", "icp"})
      .add("cameras", &options.cameras,
           "COLMAP model with the true poses: only surface that its views see counts as missing")
      .add("housing", &options.housing, "housing file with the ports of the cameras of --cameras")
      .add("estimated", &options.estimated, "COLMAP model from which the input was made");
}

void declare_measures(OptionList& visible, Options& options) {
  visible
      .add_with_default(
          "samples", &options.samples,
          "approximate number of samples on the truth, for completeness (and on an input mesh)")
      .range(1, 100'000'000)
      .add_with_default("seed", &options.seed, "random seed of the samples")
      .add_with_default(
          "min-views", &options.least_views,
          "number of views that must see a sample, else the sample does not count; with an "
          "input mesh also for the results over seen surface")
      .at_least(1)
      .add_switch("framed-only", &options.framed_only,
                  "count only points of a cloud that lie in the images of --min-views views of "
                  "--cameras, without a test for occlusion")
      .add("gross", &options.gross,
           "larger errors are gross [m] (default: four times the first tolerance)")
      .at_least(0)
      .add_switch("strip", &options.strip,
                  "report the density of a cloud along the strip of --cameras");
}

void declare_outputs(OptionList& visible, Options& options) {
  visible.add("json", &options.json, "write all results to this file (.json)")
      .output_file()
      .add("error-cloud", &options.error_cloud, "write the points coloured by error (.ply)")
      .output_file()
      .add("error-mesh", &options.error_mesh,
           "write the mesh with its vertices coloured by error (.ply)")
      .output_file()
      .add("picture", &options.picture,
           "draw the errors (.png): a cloud in the view of a camera, or depth, truth and error of "
           "a depth map")
      .output_file()
      .add("picture-camera", &options.picture_camera,
           "name of the image in --cameras whose view is drawn (default: the first image)")
      .add_with_default("picture-width", &options.picture_width,
                        "width of a cloud's picture [pixels]")
      .range(16, 16384)
      .add_with_default("color-max", &options.color_max,
                        "error at the end of the colour scale [m] (0: twice the first tolerance)")
      .at_least(0)
      .add("aligned", &options.aligned, "write the input after alignment (.ply)")
      .output_file()
      .add("transform-out", &options.transform,
           "write the alignment to this file, as a 4 x 4 matrix, row by row")
      .output_file();
}

void declare_rendering(OptionList& visible, Options& options) {
  visible
      .add_text(
          "render", [&](const std::string& text) { options.rendered_views = names_of(text); },
          "render the mesh into these views of --cameras, through their ports: names of images, "
          "separated by commas, or all")
      .add("render-folder", &options.render_folder,
           "folder for the rendered pictures: the mesh with its own colours, and with "
           "--truth-file also coloured by error")
      .output_folder()
      .add_with_default("render-type", &options.render_type, "format of the pictures: png, jpg")
      .one_of({"png", "jpg"})
      .add_with_default("render-samples", &options.render_samples,
                        "rays along each side of a pixel, whose mean is the pixel's colour")
      .range(1, 16)
      .add_with_default("render-width", &options.render_width,
                        "width of the pictures [pixels] (0: width of the camera's images)")
      .zero_or(1, 16384)
      .add("photographs", &options.photographs,
           "folder with the images of --cameras: reports the PSNR of the rendered views");
}

// In the order of --help.
void declare(OptionList& visible, Options& options) {
  declare_inputs(visible, options);
  declare_measures(visible, options);
  declare_outputs(visible, options);
  declare_rendering(visible, options);
  UnusedInput::declare(visible, options.allow_missing);
}

void check_rendering(const Options& options) {
  const bool renders = !options.rendered_views.empty();
  const std::pair<const char*, const std::filesystem::path&> of_rendering[] = {
      {"--render-folder", options.render_folder}, {"--photographs", options.photographs}};
  for (const auto& [name, path] : of_rendering)
    if (!path.empty() && !renders) fail("{} needs --render: the views to render", name);
  if (!renders) return;
  if (options.cameras.empty()) fail("--render needs --cameras");
  if (options.render_folder.empty() && options.photographs.empty())
    fail("--render needs --render-folder or --photographs");
  if (options.render_width > 0 && !options.photographs.empty())
    fail("--render-width {}: photographs are compared at their own width only",
         options.render_width);
}

// Without the truth, a mesh can only be rendered.
void check_truth(const Options& options) {
  if (!options.truth.empty()) return;
  if (options.rendered_views.empty()) fail("--truth-file is missing (-m FILE)");
  for (const char* name : {"error-cloud", "error-mesh", "picture", "aligned", "transform-out",
                           "align", "strip", "framed-only"})
    if (given(options.parsed, name)) fail("--{} needs --truth-file", name);
}

void check(const Options& options) {
  check_truth(options);
  check_rendering(options);
  if (options.align == "centres" && (options.estimated.empty() || options.cameras.empty()))
    fail("--align centres needs --estimated and --cameras");
  if (options.align != "centres" && !options.estimated.empty())
    fail("--estimated {}: is used only with --align centres", options.estimated.string());
  if (!options.housing.empty() && options.cameras.empty())
    fail("--housing needs --cameras: the cameras behind its ports");
  if (options.framed_only && options.cameras.empty()) fail("--framed-only needs --cameras");
  if (options.strip && options.cameras.empty()) fail("--strip needs --cameras");
  if (!options.picture_camera.empty() && options.cameras.empty())
    fail("--picture-camera needs --cameras");
}

// Warns of valid options that have no effect.
void warn_of_no_effect(const Options& options) {
  const auto warn = [&](bool without_effect, std::initializer_list<const char*> names,
                        const char* cause) {
    if (without_effect) warn_without_effect(options.parsed, names, cause);
  };
  const bool is_map = options.input.extension() == ".dmap";
  warn(is_map, {"samples", "seed", "min-views", "gross"}, "on a depth map");
  warn(options.truth.empty(), {"samples", "seed", "min-views", "gross", "tolerance"},
       "without --truth-file");
  warn(!is_map && options.cameras.empty(), {"min-views"}, "without --cameras");
  warn(options.picture.empty(), {"picture-camera"}, "without --picture");
  warn(options.picture.empty() || is_map, {"picture-width"}, "without --picture of a cloud");
  warn(options.picture.empty() && options.error_cloud.empty() && options.error_mesh.empty() &&
           (options.render_folder.empty() || options.truth.empty()),
       {"color-max"}, "without pictures, clouds or meshes coloured by error");
  warn(options.rendered_views.empty(), {"render-samples", "render-width"}, "without --render");
  warn(options.render_folder.empty(), {"render-type"}, "without --render-folder");
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  ProgramOptions program{"EvaluateReconstruction",
                         "compares a cloud, mesh or depth map with the ground truth",
                         {},
                         {}};
  program.version = version_line(program.name);
  declare(program.visible, options);
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  if (options.color_max == 0) options.color_max = 2 * options.tolerances.front();
  check(options);
  warn_of_no_effect(options);
  return options;
}

}  // namespace axial::apps
