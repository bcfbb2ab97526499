// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string>

#include "base/error.h"
#include "base/log.h"
#include "base/not_built.h"
#include "base/output_name.h"
#include "base/setting_names.h"
#include "base/split.h"
#include "base/version.h"
#include "io/images/bit_depth.h"
#include "io/openmvs/scene_files.h"
#include "io/openmvs/scene_options.h"
#include "settings.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// The values of the command line before they are checked and converted.
struct Raw {
  std::string input, output, mesh, views_file, mask_path, export_type = "ply";
  io::SceneOptions scene;
  int ignore_mask_label = -1;
  unsigned empty_color = 0xFF7F27, resolution_level = 0;
  int packing_heuristic = 3;
};

constexpr SettingName kOptions[] = {{"max_memory", "--max-memory"}, {"tiles", "--tiles"}};

std::string option_of(std::string_view setting) {
  return name_in(kOptions, setting);
}

std::vector<NotBuilt> not_built() {
  return {{"virtual-face-images", "0", {"0"}},
          {"orthographic-image-resolution", "0", {"0"}},
          {"cuda-device", "-1", {"-1", "-2"}}};
}

std::vector<NotBuilt> not_built_hidden() {
  return {{"transfer-texture-file", "", {""}}, {"indices-file", "", {""}}};
}

void declare_io(OptionList& list, Raw& raw, Settings& settings) {
  list.add("input-file,i", &raw.input, "scene with cameras and images")
      .add("mesh-file,m", &raw.mesh, "mesh to texture: PLY, OBJ, GLB or glTF (<input>.ply)")
      .add("output-file,o", &raw.output, "textured mesh to write (<input>_texture)")
      .add_with_default("export-type", &raw.export_type,
                        "formats to write, separated by commas: ply, obj, glb, gltf; if it is not "
                        "given, the extension of --output-file decides")
      .add_with_default("decimate", &settings.decimate,
                        "part of the faces to keep, from 0 to 1; the mesh is simplified first")
      .add_with_default("close-holes", &settings.close_holes,
                        "with --decimate below 1: close holes of at most this many edges (0: none)")
      .add_with_default("max-memory", &settings.survey.memory.megabytes,
                        "largest memory to use [MB] (0: 70 % of the free memory)")
      .add_with_default("tiles", &settings.texture.tiles,
                        "make this number of meshes, <output>.tileI-N, one after the other, in "
                        "less memory; their colours agree where they meet")
      .add_with_default("resolution-level", &raw.resolution_level,
                        "how many times the images are halved")
      .add_with_default("min-resolution", &settings.survey.resolution.min,
                        "the longest side is not halved below this [px]")
      .add_with_default(
          "ignore-mask-label", &raw.ignore_mask_label,
          "mask value to leave out; -1: no masks, but the black borders that undistortion leaves "
          "are left out (default with --mask-path: 0); -2: all pixels are used")
      .add("mask-path", &raw.mask_path,
           "folder with a mask for every image: a.mask.png, a.jpg.png, a_mask.png or a.png for "
           "a.jpg, in the same subfolders as the images");
  io::declare_bit_depth(list, settings.survey.bit_depth);
}

void declare_texturing(OptionList& list, Raw& raw, texture::Options& options) {
  list.add_with_default("outlier-threshold", &options.outlier_threshold,
                        "leave out views of a face whose colour is less likely than this among "
                        "the colours of all its views (0: none)")
      .add_with_default("cost-smoothness-ratio", &options.labels.cost_smoothness_ratio,
                        "1: the best view for each face; near 0: few seams")
      .add_with_default("global-seam-leveling", &options.leveling.global,
                        "correct the colours of whole parts, so that they agree at seams")
      .add_with_default("local-seam-leveling", &options.leveling.local,
                        "correct colours near seams, so that they are invisible")
      .add_with_default("sharpness-weight", &options.sharpness_weight,
                        "amount of an unsharp mask (0: none)")
      .add_with_default("max-texture-size", &options.packing.max_size,
                        "largest side of a texture [px] (0: 32768)")
      .add_with_default("texture-size-multiple", &options.packing.multiple,
                        "sides of textures are multiples of this [px] (0: powers of two)")
      .add_with_default("empty-color", &raw.empty_color,
                        "color of faces that no view sees: 65536 red + 256 green + blue")
      .add_with_default("patch-packing-heuristic", &raw.packing_heuristic,
                        "accepted and without effect");
}

template <class T>
void check_range(const char* name, T value, T low, T high) {
  if (!(value >= low && value <= high))
    fail("--{} {}: must be from {} to {}", name, value, low, high);
}

void check_values(const Raw& raw, const Settings& settings) {
  check_range("decimate", settings.decimate, 1e-6, 1.0);
  check_range("close-holes", settings.close_holes, std::size_t{0}, std::size_t{1000});
  check_range("tiles", settings.texture.tiles, std::size_t{1}, texture::kMostTiles);
  check_range("resolution-level", raw.resolution_level, 0u, 16u);
  check_range("min-resolution", settings.survey.resolution.min, 1, 1 << 16);
  check_range("ignore-mask-label", raw.ignore_mask_label, -2, 65535);
  check_range("outlier-threshold", settings.texture.outlier_threshold, 0.0, 0.999);
  check_range("cost-smoothness-ratio", settings.texture.labels.cost_smoothness_ratio, 0.0, 100.0);
  check_range("sharpness-weight", settings.texture.sharpness_weight, 0.0, 10.0);
  if (settings.texture.packing.max_size != 0)
    check_range("max-texture-size", settings.texture.packing.max_size, 16, 32768);
  check_range("texture-size-multiple", settings.texture.packing.multiple, 0,
              settings.texture.packing.max_size == 0 ? 32768 : settings.texture.packing.max_size);
  check_range("max-memory", settings.survey.memory.megabytes, std::uint64_t{0},
              std::uint64_t{1} << 40);
  check_range("empty-color", raw.empty_color, 0u, 0xFFFFFFu);
  io::check_bit_depth(settings.survey.bit_depth, "--bit-depth");
}

std::vector<io::TexturedFormat> formats_of(const std::string& list) {
  std::vector<io::TexturedFormat> formats;
  for (const std::string_view name : split(list, ',')) {
    const auto format = io::textured_format(name);
    if (!format) fail("--export-type {}: must be one or more of ply, obj, glb, gltf", list);
    if (std::ranges::find(formats, *format) == formats.end()) formats.push_back(*format);
  }
  if (formats.empty()) fail("--export-type: must be one or more of ply, obj, glb, gltf");
  return formats;
}

// The formats of --export-type. If it is not given, the extension of the output decides, if it is
// that of a mesh.
std::vector<io::TexturedFormat> chosen_formats(const ParsedOptions& parsed, const Raw& raw) {
  const std::string extension = known_extension(raw.output);
  if (given(parsed, "export-type") || extension.empty() || extension == ".mvs")
    return formats_of(raw.export_type);
  return formats_of(extension.substr(1));
}

// The name of the output, and its formats.
void take_output(const ParsedOptions& parsed, const Raw& raw, Settings& settings) {
  const fs::path output = output_in_working_folder(parsed.common, raw.output, "--output-file");
  refuse_other_format(output, "--output-file");
  settings.formats = chosen_formats(parsed, raw);
  const bool is_ply =
      std::ranges::find(settings.formats, io::TexturedFormat::ply) != settings.formats.end();
  settings.output = io::mesh_beside(settings.survey.files.scene, output, "_texture", is_ply) +=
      ".mvs";
  refuse_control_characters(settings.output, "--output-file");
}

void take_paths(const CommonOptions& common, const Raw& raw, Settings& settings) {
  const auto path = [&](const std::string& given) { return in_working_folder(common, given); };
  settings.survey.files = io::scene_files(raw.scene, raw.input, common);
  settings.mesh = path(raw.mesh);
  if (settings.mesh.empty()) settings.mesh = io::cloud_beside(settings.survey.files.scene);
  settings.survey.views_file = path(raw.views_file);
  settings.survey.mask_folder = path(raw.mask_path);
}

void convert(const Raw& raw, Options& options) {
  Settings& settings = options.settings;
  take_paths(options.parsed.common, raw, settings);
  take_output(options.parsed, raw, settings);
  settings.survey.resolution.level = raw.resolution_level;
  settings.texture.name_of = option_of;
  const bool masks_given = !raw.mask_path.empty() && !given(options.parsed, "ignore-mask-label");
  use_mask_label(settings.survey, masks_given ? 0 : raw.ignore_mask_label);
  settings.survey.compares_photographs = true;
  for (unsigned k = 0; k < 3; ++k)
    settings.texture.empty_color[k] =
        static_cast<std::uint8_t>(raw.empty_color >> (8 * (2 - k)) & 255u);
}

// Warns of valid options that have no effect. OpenMVS's own scripts give --close-holes 0 without
// --decimate, too.
void warn_of_no_effect(const Options& options) {
  const Settings& settings = options.settings;
  if (settings.decimate == 1 && settings.close_holes != 0 && given(options.parsed, "close-holes"))
    log_warning("--close-holes: without effect without --decimate");
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  options.settings.survey.memory = {0, "--max-memory", 64 * kMegabyte};
  options.settings.survey.resolution = {0, 640, 1 << 20};
  Raw raw;
  ProgramOptions program{"TextureMesh",
                         "gives a mesh textures from photographs, in air and under water",
                         OptionList("Texture options")};
  program.version = version_line(program.name);
  declare_io(program.visible, raw, options.settings);
  io::declare_scene_options(program.visible, raw.scene);
  declare_texturing(program.visible, raw, options.settings.texture);
  std::vector<NotBuilt> visible = not_built(), hidden = not_built_hidden();
  declare_not_built(program.visible, visible);
  declare_not_built(program.hidden, hidden);
  program.hidden.add("views-file", &raw.views_file,
                     "text file with the IDs or names of the images to use, one per line");
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  refuse_not_built(visible);
  refuse_not_built(hidden);
  check_values(raw, options.settings);
  convert(raw, options);
  warn_of_no_effect(options);
  return options;
}

}  // namespace axial::apps
