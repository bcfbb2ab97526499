// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/program.h"
#include "completeness.h"
#include "experiments/experiment.h"

namespace axial {

struct Arguments {
  std::string experiment, output, page;
  std::string part;  // compute only parts whose names begin so
  bool quick = false;
  CompletenessOptions completeness;  // of the experiment of that name
  std::string seeds, scene_options, dense_options, work;
};

// The options of ReproducePaper, bound to `a`.
ProgramOptions describe(Arguments& a);

// Whether the experiment is `completeness`, whose tables are printed, too.
bool is_completeness(const Arguments& a);

// A warning for each option that the experiment does not go by.
void warn_of_no_effect(const Arguments& a, const ParsedOptions& parsed);

// The experiment that was asked for, or all. Error that names the option and its value.
std::vector<experiments::Experiment> chosen_experiments(const Arguments& a,
                                                        const CommonOptions& common);

// Of everything that `a` asks for. A quick run has a folder of its own in the output folder: it
// neither takes a full run's files away nor replaces its results.
std::filesystem::path results_folder(const Arguments& a, const CommonOptions& common);

// Where an experiment keeps intermediate files until it is finished.
std::filesystem::path work_folder(const Arguments& a, const CommonOptions& common,
                                  const std::string& experiment);

}  // namespace axial
