// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include "base/error.h"
#include "chained.h"
#include "results.h"

namespace axial {
namespace po = boost::program_options;

ProgramOptions describe(Arguments& a) {
  ProgramOptions program;
  program.name = "ReproducePaper";
  program.description =
      "repeats the paper's experiments, its method beside ours: ReproducePaper EXPERIMENT -o DIR "
      "with EXPERIMENT figure2, runtime, figure3, figure4, reconstruction, sensitivity, need or "
      "all";
  program.visible.add_options()("output,o", po::value(&a.output),
                                "folder of the results (required); finished parts found there are "
                                "not computed again")(
      "quick", po::value(&a.quick)->default_value(false)->implicit_value(true),
      "fewer samples, smaller images: a look in a few minutes, in DIR/quick")(
      "part", po::value(&a.part),
      "compute only the parts whose names begin so; figures and tables come with the last part")(
      "page", po::value(&a.page), "Markdown page to bring up to date with the results");
  // The name that parse_options knows the positional argument by.
  program.hidden.add_options()("input-file", po::value(&a.experiment), "the experiment");
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
  const auto chain = [&](const char* name) {
    return Chain{work_folder(a, common, name), common.max_threads};
  };
  std::vector<experiments::Experiment> all = experiments::all_experiments(a.quick);
  all.push_back(reconstruction(chain("reconstruction"), a.quick));
  all.push_back(sensitivity(chain("sensitivity"), a.quick));
  all.push_back(need(chain("need"), a.quick));
  if (a.experiment == "all" && !a.part.empty())
    fail("--part {}: is for one experiment, not for all", a.part);
  if (a.experiment == "all") return all;
  std::string names;
  for (experiments::Experiment& experiment : all) {
    if (experiment.name == a.experiment && chosen_parts(experiment, a.part).empty())
      fail("--part {}: begins the name of no part of {}", a.part, experiment.name);
    if (experiment.name == a.experiment) return {std::move(experiment)};
    names += experiment.name + ", ";
  }
  fail("'{}' is no experiment: must be {}or all", a.experiment, names);
}

}  // namespace axial
