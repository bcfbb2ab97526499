// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/program/program.h"
#include "experiments/completeness.h"
#include "experiments/experiment.h"

namespace axial::apps {

struct Arguments {
  std::string experiment;
  std::filesystem::path output;
  std::string part;  // compute only the parts whose names begin with this text
  bool quick = false;
  experiments::CompletenessOptions completeness;  // for the experiment `completeness`
  std::string seeds, scene_options, dense_options;
  std::filesystem::path work;
};

// Returns the options of ReproducePaper. Parsing the options fills `a`.
ProgramOptions describe(Arguments& a);

// Warns of each option that has no effect on the experiment.
void warn_of_no_effect(const Arguments& a, const ParsedOptions& parsed);

// Returns the experiment that `a` names, or all experiments. Error that names the option and its
// value if `a` names no experiment or has a wrong value.
std::vector<experiments::Experiment> chosen_experiments(const Arguments& a,
                                                        const CommonOptions& common);

// The folder of all results. A quick run has its own folder inside the output folder, so that it
// does not remove or replace the results of a full run.
std::filesystem::path results_folder(const Arguments& a);

// The folder of an experiment's intermediate files, which is removed when the experiment is
// finished.
std::filesystem::path work_folder(const Arguments& a, const std::string& experiment);

}  // namespace axial::apps
