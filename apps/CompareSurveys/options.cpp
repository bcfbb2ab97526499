// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>

#include "base/error.h"
#include "base/output_name.h"
#include "base/setting_names.h"
#include "base/version.h"
#include "map/up_direction.h"
#include "settings.h"

namespace axial::apps {
namespace {

// The values of the command line before they are checked and converted.
struct Raw {
  std::string input, other, scene, other_scene, output, up, align = "none";
  double sigma_before = 0, sigma_after = 0;
};

constexpr SettingName kOptions[] = {{"allow_other_place", "--allow-other-place"},
                                    {"ground_sample_distance", "--ground-sample-distance"},
                                    {"min_views", "--min-views"},
                                    {"epsg", "--epsg"},
                                    {"up", "--up"}};

void declare_io(OptionList& list, Raw& raw, Settings& settings) {
  list.add("input-file,i", &raw.input, "mesh of the earlier survey (PLY, OBJ, GLB or glTF)")
      .add("other", &raw.other, "mesh of the later survey (PLY, OBJ, GLB or glTF)")
      .add("scene", &raw.scene,
           "scene of the earlier survey: places that fewer than --min-views of its photographs see "
           "are not compared")
      .add("other-scene", &raw.other_scene, "the same for the later survey")
      .add("output-file,o", &raw.output,
           "begin of the names of the outputs, which go on with .change (<input>)")
      .add_with_default("max-memory", &settings.max_memory,
                        "largest memory to use [MB] (0: 70 % of the free memory)");
}

void declare_map(OptionList& list, Raw& raw, Settings& settings) {
  list.add_with_default("ground-sample-distance", &settings.compare.pixel,
                        "width of a pixel of the maps [m] (0: the mean distance of the vertices of "
                        "the coarser mesh, rounded to two digits)")
      .add("gsd", &settings.compare.pixel, "the same as --ground-sample-distance")
      .add(
          "up", &raw.up,
          "direction of the heights in the world, X,Y,Z (default: z if the earlier mesh is far "
          "from the origin or with --epsg, otherwise the normal of the plane that fits the earlier "
          "mesh best)")
      .add_with_default("epsg", &settings.epsg,
                        "EPSG code of the coordinate reference system of the surveys, a projected "
                        "one in metres (0: none)");
}

void declare_comparison(OptionList& list, Raw& raw, Settings& settings) {
  compare::ChangeOptions& changes = settings.compare.changes;
  list.add_with_default("align", &raw.align,
                        "none: both surveys have known positions in one frame; icp: the later "
                        "survey is first moved onto the ground that did not change")
      .add("sigma-before", &raw.sigma_before,
           "standard deviation of the earlier surface [m] (default: the noise is estimated where "
           "nothing changed; give both or none)")
      .add("sigma-after", &raw.sigma_after, "standard deviation of the later surface [m]")
      .add_with_default("min-pixels", &changes.least_pixels,
                        "smallest number of pixels with a significant difference in a region of "
                        "change; more if pixels are narrower than the distance of the vertices")
      .add_with_default("min-views", &settings.compare.photos.least,
                        "smallest number of photographs that see a place, with --scene or "
                        "--other-scene")
      .add_switch("allow-other-place", &settings.compare.allow_other_place,
                  "compare surveys whose reliefs show different places");
}

template <class T>
void check_range(const char* name, T value, T low, T high) {
  if (!(value >= low && value <= high))
    fail("--{} {}: must be from {} to {}", name, value, low, high);
}

void check_values(const ParsedOptions& parsed, const Raw& raw, const Settings& settings) {
  check_range("ground-sample-distance", settings.compare.pixel, 0.0, 1e6);
  check_range("epsg", settings.epsg, 0, 1 << 20);
  check_range("min-pixels", settings.compare.changes.least_pixels, 1, 1'000'000);
  check_range("min-views", settings.compare.photos.least, 1, 1000);
  if (given(parsed, "min-views") && raw.scene.empty() && raw.other_scene.empty())
    fail("--min-views needs --scene or --other-scene");
  check_range("max-memory", settings.max_memory, std::uint64_t{0}, std::uint64_t{1} << 40);
  if (raw.align != "none" && raw.align != "icp") fail("--align {}: must be none or icp", raw.align);
  if (raw.other.empty()) fail("--other is missing: the mesh of the later survey");
  const bool before = given(parsed, "sigma-before"), after = given(parsed, "sigma-after");
  if (before != after)
    fail("--sigma-{} is missing: both standard deviations must be given, or none",
         before ? "after" : "before");
  constexpr double kLeast = 1e-9, kMost = 1e3;
  if (before) check_range("sigma-before", raw.sigma_before, kLeast, kMost);
  if (after) check_range("sigma-after", raw.sigma_after, kLeast, kMost);
}

void convert(const Raw& raw, Options& options) {
  Settings& settings = options.settings;
  const CommonOptions& common = options.parsed.common;
  settings.before = in_working_folder(common, raw.input);
  settings.after = in_working_folder(common, raw.other);
  settings.scene_before = in_working_folder(common, raw.scene);
  settings.scene_after = in_working_folder(common, raw.other_scene);
  settings.working_folder = in_working_folder(common, ".");
  settings.output =
      output_or(common, raw.output, without_known_extension(settings.before), "--output-file");
  settings.up = map::parse_up(raw.up, settings.epsg, option_of);
  settings.compare.align = raw.align == "icp";
  if (raw.sigma_before > 0) settings.compare.sigmas = {raw.sigma_before, raw.sigma_after};
  settings.compare.name_of = option_of;
}

}  // namespace

std::string option_of(std::string_view setting) {
  return name_in(kOptions, setting);
}

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  Raw raw;
  ProgramOptions program{"CompareSurveys",
                         "finds what changed between two surveys of the same place, from their "
                         "meshes",
                         OptionList("Comparison options")};
  program.version = version_line(program.name);
  declare_io(program.visible, raw, options.settings);
  declare_map(program.visible, raw, options.settings);
  declare_comparison(program.visible, raw, options.settings);
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  check_values(options.parsed, raw, options.settings);
  convert(raw, options);
  return options;
}

}  // namespace axial::apps
