// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <algorithm>
#include <sstream>
#include <string_view>

#include "base/error.h"
#include "base/parse_number.h"
#include "base/program/option_values.h"
#include "base/split.h"
#include "base/version.h"
#include "experiments/chained.h"
#include "experiments/results.h"

namespace axial::apps {
namespace {

struct Chained {
  const char* name;
  experiments::Experiment (*make)(const experiments::Chain& chain, bool quick);
};
constexpr const char* kCompleteness = "completeness";
constexpr Chained kChained[] = {{"reconstruction", experiments::reconstruction},
                                {"sensitivity", experiments::sensitivity},
                                {"need", experiments::need}};

// Options of the experiment that does not repeat one of the paper's.
void declare_completeness(OptionList& list, Arguments& a) {
  list.add_with_default("preset", &a.completeness.preset,
                        "completeness: preset of SimulateUnderwater")
      .add_with_default("medium", &a.completeness.medium, "completeness: medium, air or water")
      .one_of({"air", "water"})
      .add_with_default(
          "poses", &a.completeness.poses,
          "completeness: poses, true or colmap (found by COLMAP in photographs in air)")
      .one_of({"true", "colmap"})
      .add("seeds", &a.seeds, "completeness: seeds of the scenes (default: 11,12,13)")
      .add("tolerance", &a.completeness.tolerance,
           "completeness: tolerance [m] (default: 0.002 for closeup and thicket, 0.005 for others)")
      .at_least(0)
      .add("scene-options", &a.scene_options,
           "completeness: more options of SimulateUnderwater, in quotes")
      .add("dense-options", &a.dense_options,
           "completeness: more options of DensifyPointCloud, in quotes")
      .add("work", &a.work,
           "completeness: folder that keeps scenes and clouds for another run (default: they are "
           "removed)");
}

experiments::Words words_of(const std::string& text) {
  experiments::Words words;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::vector<int> seeds_of(const std::string& text) {
  std::vector<int> seeds;
  for (const std::string_view word : split(text, ',')) {
    const auto seed = parse_number<int>(word);
    if (!seed || *seed < 0) fail("--seeds {}: must be whole numbers, separated by commas", text);
    seeds.push_back(*seed);
  }
  return seeds;
}

// Error that names the option for seeds that are missing or occur twice.
void check(const experiments::CompletenessOptions& o) {
  if (o.seeds.empty()) fail("--seeds is empty: must be whole numbers, separated by commas");
  std::vector<int> seeds = o.seeds;
  std::ranges::sort(seeds);
  if (const auto twice = std::ranges::adjacent_find(seeds); twice != seeds.end())
    fail("--seeds names {} twice", *twice);
}

experiments::Experiment completeness_of(const Arguments& a, const CommonOptions& common) {
  experiments::CompletenessOptions options = a.completeness;
  if (!a.seeds.empty()) options.seeds = seeds_of(a.seeds);
  options.scene = words_of(a.scene_options);
  if (a.quick && options.scene.empty())
    options.scene = {"--views", "5", "--width", "320", "--height", "240", "--coarseness", "4"};
  options.dense = words_of(a.dense_options);
  check(options);
  const std::filesystem::path work =
      a.work.empty() ? work_folder(a, experiments::completeness_name(options)) : a.work;
  return experiments::completeness({work, common.max_threads}, options);
}

bool is_completeness(const Arguments& a) {
  return a.experiment == kCompleteness;
}

}  // namespace

void warn_of_no_effect(const Arguments& a, const ParsedOptions& parsed) {
  if (is_completeness(a)) return;
  warn_without_effect(
      parsed,
      {"preset", "medium", "poses", "seeds", "tolerance", "scene-options", "dense-options", "work"},
      fmt::format("except on the experiment {}", kCompleteness));
}

ProgramOptions describe(Arguments& a) {
  ProgramOptions program;
  program.name = "ReproducePaper";
  program.version = version_line(program.name);
  program.description =
      "repeats the paper's experiments with the paper's method and with ours: ReproducePaper "
      "EXPERIMENT -o DIR, where EXPERIMENT is figure2, runtime, figure3, figure4, reconstruction, "
      "sensitivity, need, all or completeness (clouds of simulated scenes, by the number of "
      "cameras that see a place)";
  program.visible
      .add("output,o", &a.output,
           "folder of the results (required); finished parts in this folder are not computed again")
      .output_folder()
      .add_switch("quick", &a.quick,
                  "fewer samples and smaller images: results in a few minutes, in DIR/quick")
      .add("part", &a.part,
           "compute only the parts whose names begin with this text; the numbers of all parts are "
           "written after the last part");
  declare_completeness(program.visible, a);
  // parse_options uses this name for the positional argument.
  program.hidden.add("input-file", &a.experiment, "the experiment");
  return program;
}

std::filesystem::path results_folder(const Arguments& a) {
  return a.quick ? a.output / "quick" : a.output;
}

std::filesystem::path work_folder(const Arguments& a, const std::string& experiment) {
  return results_folder(a) / "work" / experiment;
}

std::vector<experiments::Experiment> chosen_experiments(const Arguments& a,
                                                        const CommonOptions& common) {
  if (a.output.empty()) fail("no output folder given (-o DIR)");
  if (a.experiment == "all" && !a.part.empty())
    fail("--part {}: is for one experiment, not for all", a.part);
  std::vector<experiments::Experiment> chosen;
  std::string names;
  const auto asked_for = [&](const std::string& name) {
    names += name + ", ";
    return a.experiment == "all" || a.experiment == name;
  };
  for (experiments::Experiment& experiment : experiments::all_experiments(a.quick))
    if (asked_for(experiment.name)) chosen.push_back(std::move(experiment));
  // Made only if asked for: they read the chain's programs, which other experiments do not need.
  for (const auto& [name, make] : kChained)
    if (asked_for(name))
      chosen.push_back(make({work_folder(a, name), common.max_threads}, a.quick));
  // Not part of `all`, because it does not repeat an experiment of the paper.
  if (is_completeness(a)) chosen.push_back(completeness_of(a, common));
  if (chosen.empty())
    fail("'{}' is not an experiment: must be {}{} or all", a.experiment, names, kCompleteness);
  if (experiments::chosen_parts(chosen.front(), a.part).empty())
    fail("--part {}: no part has a name that begins with this text, in the experiment {}", a.part,
         a.experiment);
  return chosen;
}

}  // namespace axial::apps
