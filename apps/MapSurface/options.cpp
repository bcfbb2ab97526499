// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/parse_number.h"
#include "base/program/option_values.h"
#include "base/program/output_name.h"
#include "base/split.h"
#include "base/version.h"
#include "io/images/bit_depth.h"
#include "io/openmvs/scene_files.h"
#include "io/openmvs/scene_options.h"
#include "map/up_direction.h"
#include "settings.h"
#include "survey/photograph_options.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

// The values of the command line before they are checked and converted.
struct Raw {
  std::string input, up;
  io::SceneOptions scene;
};

void declare_io(OptionList& list, Raw& raw, Settings& settings) {
  list.add("input-file,i", &raw.input, "scene with cameras and images")
      .add("mesh-file,m", &settings.mesh,
           "mesh to map: PLY, OBJ, GLB or glTF (<input>.ply); a mesh without textures is textured "
           "first, as by TextureMesh")
      .add("output-file,o", &settings.output, "begin of the names of the maps (<input>_map)")
      .output_file()
      .add_max_memory();
}

std::vector<int> widths_of(const std::string& text) {
  std::vector<int> widths;
  for (const std::string_view word : split(text, ',')) {
    const std::optional<int> width = parse_number<int>(trimmed(word));
    if (!width || *width < 1 || *width > map::kMostPixels)
      fail("--widths {}: must be numbers of pixels from 1 to 1000000, separated by commas", text);
    if (std::ranges::find(widths, *width) != widths.end())
      fail("--widths {}: has {} twice", text, *width);
    widths.push_back(*width);
  }
  if (widths.empty()) fail("--widths: must be numbers of pixels, separated by commas");
  return widths;
}

void declare_copies(OptionList& list, Settings& settings) {
  list.add_choice(
          "preset", &settings.copies.preset,
          {{"gis", map::Preset::gis},
           {"taglab", map::Preset::taglab},
           {"archive", map::Preset::archive}},
          "copies for other programs beside the maps: gis: none, taglab: orthomosaic and "
          "heights for TagLab, in blocks of at most 32767 px, archive: all maps as lossless "
          "GeoTIFF with world files and a description in XML")
      .add_text(
          "widths",
          [&settings](const std::string& text) { settings.copies.widths = widths_of(text); },
          "write further copies of orthomosaic and heights with these widths [px], separated by "
          "commas, at most that of the map")
      .add("profiles", &settings.profiles,
           "lines (GeoJSON, GeoPackage or shape file) in the coordinates of the map, along which "
           "the heights are written as CSV, GeoPackage and DXF");
}

void declare_map(OptionList& list, Raw& raw, Settings& settings) {
  list.add_with_default("ground-sample-distance", &settings.pixel,
                        "width of a pixel of the maps [m] (0: the median width of a photograph's "
                        "pixel on the mesh, rounded to two digits)")
      .range(0, 1e6)
      .add("gsd", &settings.pixel, "the same as --ground-sample-distance")
      .add("up", &raw.up,
           "direction of the heights in the world, X,Y,Z (default: z if the scene has an offset or "
           "with --epsg, otherwise the normal of the plane that fits the mesh best)")
      .add_with_default("epsg", &settings.epsg,
                        "EPSG code of the coordinate reference system of the scene, a projected "
                        "one in metres (0: none)")
      .range(0, 1 << 20)
      .add_with_default("image-noise", &settings.image_noise,
                        "standard deviation of a place in a photograph [px], for the map of the "
                        "expected errors of heights (0: no such map)")
      .range(0, 1000)
      .add_switch("hillshade", &settings.hillshade, "write a picture of the relief, too")
      .add_with_default("contours", &settings.contours,
                        "write contour lines with this difference of heights [m] (0: none)")
      .range(0, 1e6)
      .sets("contour_interval");
  boundary::declare(list, settings.boundary);
  boundary::declare_like(list, settings.boundary);
}

void declare_photographs(OptionList& list, Settings& settings) {
  survey::declare_masks(list, settings.survey);
  io::declare_bit_depth(list, settings.survey.bit_depth);
  survey::declare_colors(list, settings.survey);
}

void convert(const Raw& raw, Options& options) {
  Settings& settings = options.settings;
  // The square of a tiny noise is 0, and the expected errors would be NaN.
  if (settings.image_noise > 0) check_range("image-noise", settings.image_noise, 1e-6, 1000);
  settings.survey.files = io::scene_files(raw.scene, raw.input, options.parsed);
  const fs::path& scene = settings.survey.files.scene;
  if (settings.mesh.empty()) settings.mesh = io::cloud_beside(scene);
  settings.output =
      output_or(settings.output, without_known_extension(scene) += "_map", "--output-file");
  settings.up = map::parse_up(raw.up, settings.epsg);
  boundary::check(options.parsed, settings.boundary);
  boundary::check_like(options.parsed);
  survey::take_masks(options.parsed, settings.survey);
  settings.survey.compares_photographs = true;
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
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
  declare_copies(program.visible, options.settings);
  declare_photographs(program.visible, options.settings);
  program.hidden.add("views-file", &options.settings.survey.views_file,
                     "text file with the IDs or names of the images to use, one per line");
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  if (given(options.parsed, "gsd") && given(options.parsed, "ground-sample-distance"))
    fail("--gsd: is the same as --ground-sample-distance; give one of them");
  convert(raw, options);
  return options;
}

}  // namespace axial::apps
