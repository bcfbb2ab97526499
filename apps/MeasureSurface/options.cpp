// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>

#include "base/error.h"
#include "base/program/output_name.h"
#include "base/version.h"
#include "settings.h"

namespace axial::apps {
namespace {

// The values of the command line that are converted.
struct Raw {
  double length_sigma = 0;  // [%]
};

void declare(OptionList& list, Raw& raw, Settings& settings) {
  list.add("input-file,i", &settings.mesh, "mesh (PLY, OBJ, GLB or glTF)")
      .required("the mesh")
      .add("areas", &settings.areas,
           "polygons: GeoJSON, GeoPackage or shape file with one layer of polygons")
      .required("the file of polygons")
      .add("earlier", &settings.earlier,
           "mesh of an earlier survey in the same coordinates, for the change of each polygon")
      .add_switch("allow-other-place", &settings.allow_other_place,
                  "with --earlier: compare surveys that seem to show different places")
      .add("output-file,o", &settings.output,
           "begin of the names of the tables, which go on with .csv and .gpkg (<input>_areas)")
      .output_file();
  map::declare_place(list, "polygons", settings.place);
  list.add_with_default("length-sigma", &raw.length_sigma,
                        "standard deviation of lengths [%], as RefinePoses states it (0: not "
                        "known; the standard deviations are then without that of the scale)")
      .range(0, 100)
      .add_max_memory();
}

void convert(const Raw& raw, Options& options) {
  Settings& settings = options.settings;
  if (settings.allow_other_place && settings.earlier.empty())
    fail("--allow-other-place is only for --earlier");
  settings.output = output_or(settings.output, without_known_extension(settings.mesh) += "_areas",
                              "--output-file");
  if (settings.output.extension() == ".csv" || settings.output.extension() == ".gpkg")
    settings.output.replace_extension();
  settings.length_sigma = raw.length_sigma / 100;
  map::take_place(options.parsed, settings.place);
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  Raw raw;
  ProgramOptions program{"MeasureSurface",
                         "measures areas, rugosity, slopes and volumes of a mesh in polygons",
                         OptionList("Measuring options")};
  program.version = version_line(program.name);
  declare(program.visible, raw, options.settings);
  options.parsed = parse_options(argc, argv, program);
  if (options.parsed.run) convert(raw, options);
  return options;
}

}  // namespace axial::apps
