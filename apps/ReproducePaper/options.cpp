// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include "base/error.h"
#include "chained.h"
#include "results.h"

namespace axial {
namespace {

struct Chained {
  const char* name;
  experiments::Experiment (*make)(const Chain& chain, bool quick);
};
constexpr Chained kChained[] = {
    {"reconstruction", reconstruction}, {"sensitivity", sensitivity}, {"need", need}};

}  // namespace

ProgramOptions describe(Arguments& a) {
  ProgramOptions program;
  program.name = "ReproducePaper";
  program.description =
      "repeats the paper's experiments, its method beside ours: ReproducePaper EXPERIMENT -o DIR "
      "with EXPERIMENT figure2, runtime, figure3, figure4, reconstruction, sensitivity, need or "
      "all";
  program.visible
      .add("output,o", &a.output,
           "folder of the results (required); finished parts found there are not computed again")
      .add_switch("quick", &a.quick,
                  "fewer samples, smaller images: a look in a few minutes, in DIR/quick")
      .add(
          "part", &a.part,
          "compute only the parts whose names begin so; figures and tables come with the last part")
      .add("page", &a.page, "Markdown page to bring up to date with the results");
  // The name that parse_options knows the positional argument by.
  program.hidden.add("input-file", &a.experiment, "the experiment");
  return program;
}

std::filesystem::path results_folder(const Arguments& a, const CommonOptions& common) {
  const std::filesystem::path folder = in_working_folder(common, a.output);
  return a.quick ? folder / "quick" : folder;
}

std::filesystem::path work_folder(const Arguments& a, const CommonOptions& common,
                                  const std::string& experiment) {
  return results_folder(a, common) / "work" / experiment;
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
  // Made only if asked for: they read the chain's programs, which the others do without.
  for (const auto& [name, make] : kChained)
    if (asked_for(name))
      chosen.push_back(make({work_folder(a, common, name), common.max_threads}, a.quick));
  if (chosen.empty()) fail("'{}' is no experiment: must be {}or all", a.experiment, names);
  if (chosen_parts(chosen.front(), a.part).empty())
    fail("--part {}: begins the name of no part of {}", a.part, a.experiment);
  return chosen;
}

}  // namespace axial
