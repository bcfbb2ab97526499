// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <string>

#include "base/error.h"
#include "base/output_name.h"
#include "base/setting_names.h"
#include "base/version.h"
#include "io/images/bit_depth.h"
#include "io/openmvs/scene_files.h"
#include "io/openmvs/scene_options.h"
#include "map/up_direction.h"
#include "settings.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// The values of the command line before they are checked and converted.
struct Raw {
  std::string input, output, mesh, up, mask_path, views_file;
  io::SceneOptions scene;
  int ignore_mask_label = -1;
};

constexpr SettingName kOptions[] = {{"max_memory", "--max-memory"},
                                    {"ground_sample_distance", "--ground-sample-distance"},
                                    {"contour_interval", "--contours"},
                                    {"epsg", "--epsg"},
                                    {"up", "--up"}};

void declare_io(OptionList& list, Raw& raw, Settings& settings) {
  list.add("input-file,i", &raw.input, "scene with cameras and images")
      .add("mesh-file,m", &raw.mesh,
           "mesh to map: PLY, OBJ, GLB or glTF (<input>.ply); a mesh without textures is textured "
           "first, as by TextureMesh")
      .add("output-file,o", &raw.output, "begin of the names of the maps (<input>_map)")
      .add_with_default("max-memory", &settings.survey.memory.megabytes,
                        "largest memory to use [MB] (0: 70 % of the free memory)");
}

void declare_map(OptionList& list, Raw& raw, Settings& settings) {
  list.add_with_default("ground-sample-distance", &settings.pixel,
                        "width of a pixel of the maps [m] (0: the median width of a photograph's "
                        "pixel on the mesh, rounded to two digits)")
      .add("gsd", &settings.pixel, "the same as --ground-sample-distance")
      .add("up", &raw.up,
           "direction of the heights in the world, X,Y,Z (default: z if the scene has an offset or "
           "with --epsg, otherwise the normal of the plane that fits the mesh best)")
      .add_with_default("epsg", &settings.epsg,
                        "EPSG code of the coordinate reference system of the scene, a projected "
                        "one in metres (0: none)")
      .add_with_default("image-noise", &settings.image_noise,
                        "standard deviation of a place in a photograph [px], for the map of the "
                        "expected errors of heights (0: no such map)")
      .add_switch("hillshade", &settings.hillshade, "write a picture of the relief, too")
      .add_with_default("contours", &settings.contours,
                        "write contour lines with this difference of heights [m] (0: none)");
}

void declare_photographs(OptionList& list, Raw& raw, Settings& settings) {
  list.add_with_default(
          "ignore-mask-label", &raw.ignore_mask_label,
          "mask value to leave out; -1: no masks, but the black borders that undistortion leaves "
          "are left out (default with --mask-path: 0); -2: all pixels are used")
      .add("mask-path", &raw.mask_path,
           "folder with a mask for every image: a.mask.png, a.jpg.png, a_mask.png or a.png for "
           "a.jpg, in the same subfolders as the images");
  io::declare_bit_depth(list, settings.survey.bit_depth);
}

template <class T>
void check_range(const char* name, T value, T low, T high) {
  if (!(value >= low && value <= high))
    fail("--{} {}: must be from {} to {}", name, value, low, high);
}

void check_values(const Raw& raw, const Settings& settings) {
  check_range("ground-sample-distance", settings.pixel, 0.0, 1e6);
  check_range("epsg", settings.epsg, 0, 1 << 20);
  check_range("image-noise", settings.image_noise, 0.0, 1000.0);
  // The square of a tiny noise is 0, and the expected errors would be NaN.
  if (settings.image_noise > 0) check_range("image-noise", settings.image_noise, 1e-6, 1000.0);
  check_range("contours", settings.contours, 0.0, 1e6);
  check_range("ignore-mask-label", raw.ignore_mask_label, -2, 65535);
  check_range("max-memory", settings.survey.memory.megabytes, std::uint64_t{0},
              std::uint64_t{1} << 40);
  io::check_bit_depth(settings.survey.bit_depth, "--bit-depth");
}

void take_photographs(const Options& options, const Raw& raw, survey::Options& survey) {
  const bool masks_given = !raw.mask_path.empty() && !given(options.parsed, "ignore-mask-label");
  use_mask_label(survey, masks_given ? 0 : raw.ignore_mask_label);
  survey.mask_folder = in_working_folder(options.parsed.common, raw.mask_path);
  survey.views_file = in_working_folder(options.parsed.common, raw.views_file);
  survey.compares_photographs = true;
}

void convert(const Raw& raw, Options& options) {
  Settings& settings = options.settings;
  const CommonOptions& common = options.parsed.common;
  settings.survey.files = io::scene_files(raw.scene, raw.input, common);
  const fs::path& scene = settings.survey.files.scene;
  settings.mesh = raw.mesh.empty() ? io::cloud_beside(scene) : in_working_folder(common, raw.mesh);
  settings.output =
      output_or(common, raw.output, without_known_extension(scene) += "_map", "--output-file");
  settings.up = map::parse_up(raw.up, settings.epsg, option_of);
  take_photographs(options, raw, settings.survey);
}

}  // namespace

std::string option_of(std::string_view setting) {
  return name_in(kOptions, setting);
}

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  options.settings.survey.memory = {0, "--max-memory", 96 * kMegabyte};
  options.settings.survey.resolution = {0, 640, 1 << 20};
  Raw raw;
  ProgramOptions program{
      "MapSurface",
      "makes height maps and orthomosaics of a mesh from photographs, in air and "
      "under water",
      OptionList("Map options")};
  program.version = version_line(program.name);
  declare_io(program.visible, raw, options.settings);
  io::declare_scene_options(program.visible, raw.scene);
  declare_map(program.visible, raw, options.settings);
  declare_photographs(program.visible, raw, options.settings);
  program.hidden.add("views-file", &raw.views_file,
                     "text file with the IDs or names of the images to use, one per line");
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  if (given(options.parsed, "gsd") && given(options.parsed, "ground-sample-distance"))
    fail("--gsd: is the same as --ground-sample-distance; give one of them");
  check_values(raw, options.settings);
  convert(raw, options);
  return options;
}

}  // namespace axial::apps
