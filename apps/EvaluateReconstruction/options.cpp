// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <cmath>
#include <string_view>

#include "base/error.h"
#include "base/log.h"
#include "base/output_name.h"
#include "base/parse_number.h"
#include "base/split.h"
#include "base/unused_input.h"
#include "base/version.h"

namespace axial::apps {
namespace {

// The options as text, before they are checked.
struct Texts {
  std::string input, truth, tolerance = "0.005", cameras, housing, estimated;
  std::string json, error_cloud, error_mesh, picture, aligned, transform;
  std::string render, photographs, render_folder;
};

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

void declare_inputs(OptionList& visible, Options& options, Texts& texts) {
  visible
      .add("input-file,i", &texts.input,
           "file to evaluate: a cloud (.ply), a mesh, with or without textures (.ply, .obj, .glb, "
           ".gltf), or a depth map (.dmap)")
      .add("truth-file,m", &texts.truth,
           "ground truth: a mesh (.ply, .obj, .glb, .gltf), or for a depth map the distances along "
           "its rays (.tiff); "
           "not needed for --render")
      .add_with_default("tolerance", &texts.tolerance,
                        "tolerances: largest distances that count as correct [m], separated by "
                        "commas; histograms end at 4 times the first tolerance, colours at 2 times")
      .add_with_default("align", &options.align,
                        "none; centres: similarity from the camera centres of --estimated to the "
                        "camera centres of --cameras; icp: rigid refinement on the true mesh")
      .add("cameras", &texts.cameras,
           "COLMAP model with the true poses: only surface that its views see counts as missing")
      .add("housing", &texts.housing, "housing file with the ports of the cameras of --cameras")
      .add("estimated", &texts.estimated, "COLMAP model from which the input was made");
}

void declare_measures(OptionList& visible, Options& options) {
  visible
      .add_with_default(
          "samples", &options.samples,
          "approximate number of samples on the truth, for completeness (and on an input mesh)")
      .add_with_default("seed", &options.seed, "random seed of the samples")
      .add_with_default(
          "min-views", &options.least_views,
          "number of views that must see a sample, else the sample does not count; with an "
          "input mesh also for the results over seen surface")
      .add_switch("framed-only", &options.framed_only,
                  "count only points of a cloud that lie in the images of --min-views views of "
                  "--cameras, without a test for occlusion")
      .add("gross", &options.gross,
           "larger errors are gross [m] (default: four times the first tolerance)")
      .add_switch("strip", &options.strip,
                  "report the density of a cloud along the strip of --cameras");
}

void declare_outputs(OptionList& visible, Options& options, Texts& texts) {
  visible.add("json", &texts.json, "write all results to this file (.json)")
      .add("error-cloud", &texts.error_cloud, "write the points coloured by error (.ply)")
      .add("error-mesh", &texts.error_mesh,
           "write the mesh with its vertices coloured by error (.ply)")
      .add("picture", &texts.picture,
           "draw the errors (.png): a cloud in the view of a camera, or depth, truth and error of "
           "a depth map")
      .add("picture-camera", &options.picture_camera,
           "name of the image in --cameras whose view is drawn (default: the first image)")
      .add_with_default("picture-width", &options.picture_width,
                        "width of a cloud's picture [pixels]")
      .add_with_default("color-max", &options.color_max,
                        "error at the end of the colour scale [m] (0: twice the first tolerance)")
      .add("aligned", &texts.aligned, "write the input after alignment (.ply)")
      .add("transform-out", &texts.transform,
           "write the alignment to this file, as a 4 x 4 matrix, row by row");
}

void declare_rendering(OptionList& visible, Options& options, Texts& texts) {
  visible
      .add("render", &texts.render,
           "render the mesh into these views of --cameras, through their ports: names of images, "
           "separated by commas, or all")
      .add("render-folder", &texts.render_folder,
           "folder for the rendered pictures: the mesh with its own colours, and with "
           "--truth-file also coloured by error")
      .add_with_default("render-type", &options.render_type, "format of the pictures: png, jpg")
      .add_with_default("render-samples", &options.render_samples,
                        "rays along each side of a pixel, whose mean is the pixel's colour")
      .add_with_default("render-width", &options.render_width,
                        "width of the pictures [pixels] (0: width of the camera's images)")
      .add("photographs", &texts.photographs,
           "folder with the images of --cameras: reports the PSNR of the rendered views");
}

// In the order of --help.
void declare(OptionList& visible, Options& options, Texts& texts) {
  declare_inputs(visible, options, texts);
  declare_measures(visible, options);
  declare_outputs(visible, options, texts);
  declare_rendering(visible, options, texts);
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
  if (options.render_type != "png" && options.render_type != "jpg")
    fail("--render-type is {}: must be png or jpg", options.render_type);
  if (options.render_samples < 1 || options.render_samples > 16)
    fail("--render-samples is {}: must be 1 to 16", options.render_samples);
  if (options.render_width < 0 || options.render_width > 16384)
    fail("--render-width is {}: must be 1 to 16384, or 0", options.render_width);
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
  if (options.align != "none" && options.align != "centres" && options.align != "icp")
    fail("--align is {}: must be none, centres or icp", options.align);
  if (options.align == "centres" && (options.estimated.empty() || options.cameras.empty()))
    fail("--align centres needs --estimated and --cameras");
  if (options.align != "centres" && !options.estimated.empty())
    fail("--estimated {}: is used only with --align centres", options.estimated.string());
  if (!options.housing.empty() && options.cameras.empty())
    fail("--housing needs --cameras: the cameras behind its ports");
  if (options.framed_only && options.cameras.empty()) fail("--framed-only needs --cameras");
  if (options.strip && options.cameras.empty()) fail("--strip needs --cameras");
  if (!(options.gross >= 0) || !std::isfinite(options.gross))
    fail("--gross is {}: must be a length in metres", options.gross);
  if (options.least_views == 0) fail("--min-views is 0: must be at least 1");
  if (options.samples == 0 || options.samples > 100'000'000)
    fail("--samples is {}: must be 1 to 100000000", options.samples);
  if (options.picture_width < 16 || options.picture_width > 16384)
    fail("--picture-width is {}: must be 16 to 16384", options.picture_width);
  if (!(options.color_max > 0) || !std::isfinite(options.color_max))
    fail("--color-max is {}: must be a positive length in metres", options.color_max);
  if (!options.picture_camera.empty() && options.cameras.empty())
    fail("--picture-camera needs --cameras");
}

// Warns of valid options that have no effect.
void warn_of_no_effect(const Options& options) {
  const auto warn = [&](bool without_effect, const char* name, const char* cause) {
    if (without_effect && given(options.parsed, name))
      log_warning("--{}: without effect {}", name, cause);
  };
  const bool is_map = options.input.extension() == ".dmap";
  for (const char* name : {"samples", "seed", "min-views", "gross"}) {
    warn(is_map, name, "on a depth map");
    warn(options.truth.empty(), name, "without --truth-file");
  }
  warn(options.truth.empty(), "tolerance", "without --truth-file");
  warn(!is_map && options.cameras.empty(), "min-views", "without --cameras");
  warn(options.picture.empty(), "picture-camera", "without --picture");
  warn(options.picture.empty() || is_map, "picture-width", "without --picture of a cloud");
  warn(options.picture.empty() && options.error_cloud.empty() && options.error_mesh.empty() &&
           (options.render_folder.empty() || options.truth.empty()),
       "color-max", "without pictures, clouds or meshes coloured by error");
  warn(options.rendered_views.empty(), "render-samples", "without --render");
  warn(options.render_folder.empty(), "render-type", "without --render-folder");
  warn(options.rendered_views.empty(), "render-width", "without --render");
}

std::vector<std::string> names_of(const std::string& list) {
  std::vector<std::string> names;
  for (const std::string_view name : split(list, ',')) {
    if (name.empty()) fail("--render {}: must be names of images, separated by commas", list);
    names.emplace_back(name);
  }
  return names;
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  Texts texts;
  ProgramOptions program{"EvaluateReconstruction",
                         "compares a cloud, mesh or depth map with the ground truth",
                         {},
                         {}};
  program.version = version_line(program.name);
  declare(program.visible, options, texts);
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  const auto path = [&](const std::string& text) {
    return in_working_folder(options.parsed.common, text);
  };
  const auto output = [&](const std::string& text, const char* option) {
    return output_in_working_folder(options.parsed.common, text, option);
  };
  options.input = path(texts.input);
  options.truth = path(texts.truth);
  options.tolerances = parse_tolerances(texts.tolerance);
  options.cameras = path(texts.cameras);
  options.housing = path(texts.housing);
  options.estimated = path(texts.estimated);
  options.json = output(texts.json, "--json");
  options.error_cloud = output(texts.error_cloud, "--error-cloud");
  options.error_mesh = output(texts.error_mesh, "--error-mesh");
  options.rendered_views = names_of(texts.render);
  options.render_folder =
      folder_in_working_folder(options.parsed.common, texts.render_folder, "--render-folder");
  options.photographs = path(texts.photographs);
  options.picture = output(texts.picture, "--picture");
  options.aligned = output(texts.aligned, "--aligned");
  options.transform = output(texts.transform, "--transform-out");
  if (options.color_max == 0) options.color_max = 2 * options.tolerances.front();
  check(options);
  warn_of_no_effect(options);
  return options;
}

}  // namespace axial::apps
