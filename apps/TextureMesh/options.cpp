// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string>

#include "base/error.h"
#include "base/program/option_values.h"
#include "base/program/output_name.h"
#include "base/program/tiling.h"
#include "base/split.h"
#include "base/version.h"
#include "io/images/bit_depth.h"
#include "io/openmvs/scene_files.h"
#include "io/openmvs/scene_options.h"
#include "settings.h"
#include "survey/photograph_options.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// The values of the command line before they are checked and converted.
struct Raw {
  std::string input;
  std::vector<io::TexturedFormat> formats;
  io::SceneOptions scene;
  unsigned empty_color = 0xFF7F27;
  int packing_heuristic = 3;
};

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

void declare_io(OptionList& list, Raw& raw, Settings& settings) {
  list.add("input-file,i", &raw.input, "scene with cameras and images")
      .add("mesh-file,m", &settings.mesh, "mesh to texture: PLY, OBJ, GLB or glTF (<input>.ply)")
      .add("output-file,o", &settings.output, "textured mesh to write (<input>_texture)")
      .output_file()
      .add_text_with_default(
          "export-type", "ply", [&](const std::string& text) { raw.formats = formats_of(text); },
          "formats to write, separated by commas: ply, obj, glb, gltf; if it is not "
          "given, the extension of --output-file decides")
      .add_with_default("decimate", &settings.decimate,
                        "part of the faces to keep, from 0 to 1; the mesh is simplified first")
      .range(1e-6, 1)
      .add_with_default("close-holes", &settings.close_holes,
                        "with --decimate below 1: close holes of at most this many edges (0: none)")
      .range(0, 1000)
      .add_max_memory(64 * kMegabyte)
      .add_with_default("tiles", &settings.texture.tiles,
                        "make this number of meshes, <output>.tileI-N, one after the other, in "
                        "less memory; their colours agree where they meet")
      .range(1, kMostTiles)
      .add_with_default("resolution-level", &settings.survey.resolution.level,
                        "how many times the images are halved")
      .range(0, 16)
      .add_with_default("min-resolution", &settings.survey.resolution.min,
                        "the longest side is not halved below this [px]")
      .range(1, 1 << 16);
  survey::declare_masks(list, settings.survey);
  io::declare_bit_depth(list, settings.survey.bit_depth);
  survey::declare_colors(list, settings.survey);
  boundary::declare(list, settings.boundary);
}

void declare_texturing(OptionList& list, Raw& raw, texture::Options& options) {
  list.add_with_default("outlier-threshold", &options.outlier_threshold,
                        "leave out views of a face whose colour is less likely than this among "
                        "the colours of all its views (0: none)")
      .range(0, 0.999)
      .add_with_default("cost-smoothness-ratio", &options.labels.cost_smoothness_ratio,
                        "1: the best view for each face; near 0: few seams")
      .range(0, 100)
      .add_with_default("global-seam-leveling", &options.leveling.global,
                        "correct the colours of whole parts, so that they agree at seams")
      .add_with_default("local-seam-leveling", &options.leveling.local,
                        "correct colours near seams, so that they are invisible")
      .add_with_default("sharpness-weight", &options.sharpness_weight,
                        "amount of an unsharp mask (0: none)")
      .range(0, 10)
      .add_with_default("max-texture-size", &options.packing.max_size,
                        "largest side of a texture [px] (0: 32768)")
      .zero_or(16, 32768)
      .add_with_default("texture-size-multiple", &options.packing.multiple,
                        "sides of textures are multiples of this [px] (0: powers of two)")
      .add_with_default("empty-color", &raw.empty_color,
                        "color of faces that no view sees: 65536 red + 256 green + blue")
      .range(0, 0xFFFFFF)
      .add_with_default("patch-packing-heuristic", &raw.packing_heuristic,
                        "accepted and without effect");
}

// The formats of --export-type. If it is not given, the extension of the output decides, if it is
// that of a mesh.
std::vector<io::TexturedFormat> chosen_formats(const Raw& raw, const fs::path& output) {
  if (!raw.formats.empty()) return raw.formats;
  const std::string extension = known_extension(output);
  if (extension.empty() || extension == ".mvs") return {io::TexturedFormat::ply};
  return formats_of(extension.substr(1));
}

// The name of the output, and its formats.
void take_output(const Raw& raw, Settings& settings, const Context& context) {
  const fs::path output = settings.output;
  refuse_other_format(output, "--output-file");
  settings.formats = chosen_formats(raw, output);
  const bool is_ply =
      std::ranges::find(settings.formats, io::TexturedFormat::ply) != settings.formats.end();
  settings.output =
      io::mesh_beside(settings.survey.files.scene, output, "_texture", is_ply, context) += ".mvs";
  refuse_control_characters(settings.output, "--output-file");
}

void convert(const Raw& raw, Options& options) {
  Settings& settings = options.settings;
  const int largest = settings.texture.packing.max_size;
  check_range("texture-size-multiple", settings.texture.packing.multiple, 0,
              largest == 0 ? 32768 : largest);
  settings.survey.files = io::scene_files(raw.scene, raw.input, options.parsed);
  if (settings.mesh.empty()) settings.mesh = io::cloud_beside(settings.survey.files.scene);
  take_output(raw, settings, program_context(options.parsed));
  boundary::check(options.parsed, settings.boundary);
  survey::take_masks(options.parsed, settings.survey);
  settings.survey.compares_photographs = true;
  for (unsigned k = 0; k < 3; ++k)
    settings.texture.empty_color[k] =
        static_cast<std::uint8_t>(raw.empty_color >> (8 * (2 - k)) & 255u);
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  options.settings.survey.resolution = {0, 640, 1 << 20};
  Raw raw;
  ProgramOptions program{"TextureMesh",
                         "gives a mesh textures from photographs, in air and under water",
                         OptionList("Texture options")};
  program.version = version_line(program.name);
  declare_io(program.visible, raw, options.settings);
  io::declare_scene_options(program.visible, raw.scene);
  declare_texturing(program.visible, raw, options.settings.texture);
  program.visible.add_not_built("virtual-face-images", "0", {"0"})
      .add_not_built("orthographic-image-resolution", "0", {"0"})
      .add_not_built("cuda-device", "-1", {"-1", "-2"});
  program.hidden.add_not_built("transfer-texture-file", "", {""})
      .add_not_built("indices-file", "", {""});
  program.hidden.add("views-file", &options.settings.survey.views_file,
                     "text file with the IDs or names of the images to use, one per line");
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  convert(raw, options);
  // OpenMVS's own scripts give --close-holes 0 without --decimate, too.
  if (options.settings.decimate == 1 && options.settings.close_holes != 0)
    warn_without_effect(options.parsed, {"close-holes"}, "without --decimate");
  return options;
}

}  // namespace axial::apps
