// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>
#include <string>

#include "base/error.h"
#include "base/program/output_name.h"
#include "base/version.h"
#include "map/up_direction.h"
#include "settings.h"

namespace axial::apps {
namespace {

constexpr double kLeastSigma = 1e-9, kMostSigma = 1e3;  // [m]

// The values of the command line that need others before they are converted.
struct Raw {
  std::string up;
  std::optional<double> sigma_before, sigma_after;
};

void declare_io(OptionList& list, Settings& settings) {
  list.add("input-file,i", &settings.before, "mesh of the earlier survey (PLY, OBJ, GLB or glTF)")
      .add("other", &settings.after, "mesh of the later survey (PLY, OBJ, GLB or glTF)")
      .required("the mesh of the later survey")
      .add("scene", &settings.scene_before,
           "scene of the earlier survey: places that fewer than --min-views of its photographs see "
           "are not compared")
      .add("other-scene", &settings.scene_after, "the same for the later survey")
      .add("output-file,o", &settings.output,
           "begin of the names of the outputs, which go on with .change (<input>)")
      .output_file()
      .add_max_memory();
}

void declare_map(OptionList& list, Raw& raw, Settings& settings) {
  list.add_with_default("ground-sample-distance", &settings.compare.pixel,
                        "width of a pixel of the maps [m] (0: the mean distance of the vertices of "
                        "the coarser mesh, rounded to two digits)")
      .range(0, 1e6)
      .add("gsd", &settings.compare.pixel, "the same as --ground-sample-distance")
      .add(
          "up", &raw.up,
          "direction of the heights in the world, X,Y,Z (default: z if the earlier mesh is far "
          "from the origin or with --epsg, otherwise the normal of the plane that fits the earlier "
          "mesh best)")
      .add_with_default("epsg", &settings.epsg,
                        "EPSG code of the coordinate reference system of the surveys, a projected "
                        "one in metres (0: none)")
      .range(0, 1 << 20);
  boundary::declare(list, settings.boundary);
  boundary::declare_like(list, settings.boundary);
}

void declare_comparison(OptionList& list, Raw& raw, Settings& settings) {
  compare::ChangeOptions& changes = settings.compare.changes;
  list.add_choice("align", &settings.align,
                  {{"none", Align::none},
                   {"icp", Align::ground},
                   {"targets", Align::targets},
                   {"auto", Align::automatic}},
                  "none: both surveys have known positions in one frame; icp: the later "
                  "survey is first moved onto the ground that did not change; targets: it is moved "
                  "by the targets that both surveys show; auto: targets if three or more are in "
                  "both surveys, otherwise icp")
      .add("targets", &settings.targets_before,
           "places of the targets of the earlier survey, of RefinePoses (default: "
           "target_places.json in the folder of the mesh or in refined/ there)")
      .add("other-targets", &settings.targets_after, "the same for the later survey")
      .add("sigma-before", &raw.sigma_before,
           "standard deviation of the earlier surface [m] (default: the noise is estimated where "
           "nothing changed; give both or none)")
      .range(kLeastSigma, kMostSigma)
      .add("sigma-after", &raw.sigma_after, "standard deviation of the later surface [m]")
      .range(kLeastSigma, kMostSigma)
      .add_with_default("min-pixels", &changes.least_pixels,
                        "smallest number of pixels with a significant difference in a region of "
                        "change; more if pixels are narrower than the distance of the vertices")
      .range(1, 1'000'000)
      .add_with_default("min-views", &settings.compare.photos.least,
                        "smallest number of photographs that see a place, with --scene or "
                        "--other-scene")
      .range(1, 1000)
      .add_switch("allow-other-place", &settings.compare.allow_other_place,
                  "compare surveys whose reliefs show different places");
}

void check(const ParsedOptions& parsed, const Raw& raw, const Settings& settings) {
  boundary::check(parsed, settings.boundary);
  boundary::check_like(parsed);
  if (given(parsed, "min-views") && settings.scene_before.empty() && settings.scene_after.empty())
    fail("--min-views needs --scene or --other-scene");
  const bool by_targets = settings.align == Align::targets || settings.align == Align::automatic;
  for (const char* option : {"targets", "other-targets"})
    if (given(parsed, option) && !by_targets)
      fail("--{} needs --align targets or --align auto", option);
  if (raw.sigma_before.has_value() != raw.sigma_after.has_value())
    fail("--sigma-{} is missing: both standard deviations must be given, or none",
         raw.sigma_before ? "after" : "before");
}

void convert(const Raw& raw, Options& options) {
  Settings& settings = options.settings;
  settings.working_folder = in_working_folder(options.parsed.common, ".");
  settings.output =
      output_or(settings.output, without_known_extension(settings.before), "--output-file");
  settings.up = map::parse_up(raw.up, settings.epsg);
  if (raw.sigma_before) settings.compare.sigmas = {*raw.sigma_before, *raw.sigma_after};
  settings.compare.align = settings.align == Align::ground;
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  Raw raw;
  ProgramOptions program{"CompareSurveys",
                         "finds what changed between two surveys of the same place, from their "
                         "meshes",
                         OptionList("Comparison options")};
  program.version = version_line(program.name);
  declare_io(program.visible, options.settings);
  declare_map(program.visible, raw, options.settings);
  declare_comparison(program.visible, raw, options.settings);
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  check(options.parsed, raw, options.settings);
  convert(raw, options);
  return options;
}

}  // namespace axial::apps
