// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>

#include "base/error.h"
#include "base/program/output_name.h"
#include "base/version.h"
#include "io/openmvs/scene_files.h"
#include "io/openmvs/scene_options.h"
#include "settings.h"

namespace axial::apps {
namespace {

// The values of the command line that are converted.
struct Raw {
  std::string input;
  io::SceneOptions scene;
  double least_part = 2, join_overlap = 50;  // [%]
};

void declare(OptionList& list, Raw& raw, Settings& settings) {
  list.add("input-file,i", &raw.input, "scene with cameras and images")
      .add("mesh-file,m", &settings.mesh, "mesh of the scene (<input>.ply)")
      .add("from-map", &settings.from_map,
           "labels on a map, for all photographs that see them: GeoJSON, GeoPackage or shape file "
           "with polygons or points")
      .add("from-photographs", &settings.from_photographs,
           "labels in photographs, for the map: COCO JSON with polygons or key points")
      .add("output-file,o", &settings.output,
           "begin of the names of the files, which go on with .json, or with .geojson and .gpkg "
           "(<input>_labels)")
      .output_file();
  map::declare_place(list, "labels", settings.place);
  list.add("class-field", &settings.class_field,
           "with --from-map: field with the class of a label (default: class, category, species or "
           "label)")
      .add("masks", &settings.masks,
           "with --from-map: folder for a PNG for each photograph that sees a label, with the "
           "category_id of the label at each pixel, and 0 elsewhere")
      .output_folder()
      .add_with_default("least-part", &raw.least_part,
                        "with --from-photographs: parts of a label on the map with less than this "
                        "share of its area in the photograph are left out [%]")
      .range(0, 50)
      .add_choice(
          "join", &settings.join.join,
          {{"none", labels::Join::none},
           {"name", labels::Join::name},
           {"overlap", labels::Join::overlap}},
          "with --from-photographs: unite polygons of one class that show one object: those "
          "with the same attributes.name, or those that overlap on the map")
      .add_with_default(
          "join-overlap", &raw.join_overlap,
          "with --join overlap: polygons of one object have this share of the smaller "
          "one in common [%]")
      .range(1, 100)
      .add_max_memory();
  io::declare_scene_options(list, raw.scene);
}

void require_one_direction(const ParsedOptions& parsed, const Settings& settings) {
  if (settings.from_map.empty() == settings.from_photographs.empty())
    fail("give either --from-map or --from-photographs");
  const auto refuse = [&](const char* option, const char* other) {
    if (given(parsed, option)) fail("--{} is only for {}", option, other);
  };
  if (settings.from_map.empty())
    for (const char* option : {"class-field", "masks"}) refuse(option, "--from-map");
  else
    for (const char* option : {"least-part", "join", "join-overlap"})
      refuse(option, "--from-photographs");
  if (settings.join.join != labels::Join::overlap) refuse("join-overlap", "--join overlap");
}

void convert(const Raw& raw, Options& options) {
  Settings& settings = options.settings;
  require_one_direction(options.parsed, settings);
  settings.survey.files = io::scene_files(raw.scene, raw.input, options.parsed);
  if (settings.mesh.empty()) settings.mesh = io::cloud_beside(settings.survey.files.scene);
  settings.output =
      output_or(settings.output, without_known_extension(settings.survey.files.scene) += "_labels",
                "--output-file");
  for (const char* extension : {".json", ".geojson", ".gpkg"})
    if (settings.output.extension() == extension) {
      settings.output.replace_extension();
      break;
    }
  settings.least_part = raw.least_part / 100;
  settings.join.least_overlap = raw.join_overlap / 100;
  map::take_place(options.parsed, settings.place);
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  options.settings.survey.resolution = {0, 1, 1 << 20};
  options.settings.survey.has_masks = false;
  Raw raw;
  ProgramOptions program{"ProjectLabels",
                         "carries labels from a map to photographs, or from photographs to a map",
                         OptionList("Label options")};
  program.version = version_line(program.name);
  declare(program.visible, raw, options.settings);
  options.parsed = parse_options(argc, argv, program);
  if (options.parsed.run) convert(raw, options);
  return options;
}

}  // namespace axial::apps
