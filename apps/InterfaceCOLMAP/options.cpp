// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "base/program/option_values.h"
#include "base/program/output_name.h"
#include "base/program/unused_input.h"
#include "base/version.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// The options before they are checked.
struct Values {
  std::string input, output, image_folder = "images/";
  fs::path housing, point_cloud, mask_path;
  int mask_label = 0;
  bool normalize = false, force_points = false;
  std::optional<bool> undistort;
};

// The output of an export is a folder. A file name, as for an import, is a mistake.
void refuse_file_name(const std::string& output) {
  for (const char* extension : {".mvs", ".ply", ".txt", ".bin", ".json"})
    if (fs::path(output).extension() == extension)
      fail("--output-file {}: must be a folder, because a scene (.mvs) is exported to a folder",
           output);
}

// A given folder counts from the working folder, as in OpenMVS. The default belongs to the COLMAP
// folder: another images/ in the working folder must not be used instead of the model's.
void find_image_folder(const std::string& name, Options& options) {
  const ParsedOptions& parsed = options.parsed;
  fs::path candidates[] = {in_working_folder(parsed.common, name),
                           (options.colmap_folder / name).lexically_normal()};
  if (!given(parsed, "image-folder")) std::swap(candidates[0], candidates[1]);
  std::error_code error;
  for (const fs::path& candidate : candidates) {
    if (!fs::is_directory(candidate, error)) continue;
    (options.image_folder.empty() ? options.image_folder : options.other_image_folder) = candidate;
  }
  if (!options.image_folder.empty()) return;
  const std::string also = candidates[0] == candidates[1] ? "" : " and " + candidates[1].string();
  fail("--image-folder {}: no such folder (looked for {}{})", name, candidates[0].string(), also);
}

void declare_files(OptionList& visible, Values& values) {
  visible
      .add("input-file,i", &values.input,
           "COLMAP folder: the model is in DIR/sparse, DIR/sparse/0 or DIR; or a scene (.mvs) to "
           "export to DIR/sparse, where DIR is -o or the scene's folder; with --mask-path, the "
           "folder of the photographs")
      .add("output-file,o", &values.output, "scene to write (default: DIR/scene.mvs)")
      .sets("output")
      .add_with_default("image-folder", &values.image_folder,
                        "folder of the images, in the working folder or else in DIR (the default: "
                        "in DIR first); images must have the size of their cameras")
      .add("housing", &values.housing,
           "housing file with the ports of the cameras, or Calibmar's calibration.yaml; written as "
           "<scene>.housing.json");
}

void declare_masks(OptionList& visible, Values& values) {
  visible
      .add(
          "mask-path", &values.mask_path,
          "folder with a mask for every image, as for DensifyPointCloud, or one file for all: "
          "writes these masks as COLMAP wants them (ImageReader.mask_path) into the folder -o, and "
          "no scene")
      .sets("mask_folder")
      .add_with_default("ignore-mask-label", &values.mask_label,
                        "with --mask-path: mask value of the pixels to leave out, which become "
                        "black")
      .range(0, 65535);
}

void declare_changes(OptionList& visible, Values& values) {
  visible
      .add("undistort", &values.undistort,
           "1: resample images of distorted lenses into pinhole images, which all programs can "
           "read; 0: keep the images, and write the lenses to <scene>.lenses.json (default: 0 "
           "behind ports, 1 in air)")
      .add("pointcloud-file,p", &values.point_cloud,
           "for an export: PLY cloud with views that replaces the scene's points")
      .add_with_default("normalize,f", &values.normalize,
                        "1: write intrinsics divided by the image's longer side, without its "
                        "resolution; 0: in pixels")
      .add_with_default("force-points,e", &values.force_points,
                        "accepted and without effect: sparse points are always written");
}

// The options of an export: the input is a scene.
void set_export(const Values& values, Options& options) {
  const CommonOptions& common = options.parsed.common;
  options.scene_file = std::exchange(options.colmap_folder, {});
  refuse_file_name(values.output);
  options.export_folder = values.output.empty()
                              ? options.scene_file.parent_path()
                              : folder_in_working_folder(common, values.output, "--output-file");
  std::error_code error;
  if (fs::exists(options.export_folder, error) && !fs::is_directory(options.export_folder, error))
    fail("--output-file {}: is a file, but a scene (.mvs) is exported to a folder", values.output);
  if (!values.housing.empty())
    fail("--housing {}: is not used in an export, which takes the housing file beside the scene",
         values.housing.string());
  options.point_cloud = values.point_cloud;
  warn_without_effect(options.parsed, {"undistort", "normalize", "force-points"},
                      "when a scene is exported");
  if (given(options.parsed, "image-folder"))
    options.image_folder = in_working_folder(common, values.image_folder) / "";
}

// The options of an import: the input is a COLMAP folder.
void set_import(const Values& values, Options& options) {
  const CommonOptions& common = options.parsed.common;
  options.normalize = values.normalize;
  if (!values.point_cloud.empty())
    fail("--pointcloud-file {}: is not built for an import, only for the export of a scene (.mvs)",
         values.point_cloud.string());
  if (values.force_points)
    log_warning("--force-points: without effect: sparse points are always written");
  std::error_code error;
  if (!fs::is_directory(options.colmap_folder, error))
    fail_in(options.colmap_folder, "is not a folder");
  options.named_output = in_working_folder(common, values.output);
  options.scene_file =
      with_extension(output_or(output_in_working_folder(common, values.output, "--output-file"),
                               options.colmap_folder / "scene", "--output-file"),
                     ".mvs");
  refuse_other_format(values.output, "--output-file");
  options.undistort = values.undistort;
  options.housing_file = values.housing;
  find_image_folder(values.image_folder, options);
}

// The options of masks for COLMAP: the input is the folder of the photographs.
void set_masks(const Values& values, Options& options) {
  const CommonOptions& common = options.parsed.common;
  std::error_code error;
  options.masks.images = options.colmap_folder;
  options.masks.masks = values.mask_path;
  options.masks.label = values.mask_label;
  options.masks.output = in_working_folder(common, values.output);
  if (!fs::is_directory(options.masks.images, error))
    fail("--input-file {}: must be the folder of the photographs, because --mask-path is given",
         values.input);
  if (!fs::exists(options.masks.masks, error))
    fail("--mask-path {}: not found", values.mask_path.string());
  if (values.output.empty())
    fail("--mask-path {}: needs --output-file, the folder for COLMAP's masks",
         values.mask_path.string());
  for (const char* name : {"image-folder", "housing", "undistort", "pointcloud-file", "normalize"})
    if (given(options.parsed, name))
      fail("--{}: contradicts --mask-path, which writes no scene", name);
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Values values;
  Options options;
  ProgramOptions program{"InterfaceCOLMAP",
                         "converts a COLMAP model and its images to a scene (.mvs), a scene to a "
                         "COLMAP model, or masks "
                         "to COLMAP's masks",
                         {},
                         {}};
  program.version = version_line(program.name);
  // In the order of --help.
  declare_files(program.visible, values);
  declare_changes(program.visible, values);
  declare_masks(program.visible, values);
  UnusedInput::declare(program.visible, options.allow_missing);
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  options.colmap_folder = in_working_folder(options.parsed.common, values.input);
  if (!values.mask_path.empty()) {
    set_masks(values, options);
    return options;
  }
  if (given(options.parsed, "ignore-mask-label"))
    fail("--ignore-mask-label {}: is only for --mask-path", values.mask_label);
  const bool is_export = options.colmap_folder.extension() == ".mvs";
  (is_export ? set_export : set_import)(values, options);
  return options;
}

}  // namespace axial::apps
