// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/program.h"
#include "experiments/completeness.h"
#include "experiments/experiment.h"

namespace axial::apps {

struct Arguments {
  std::string experiment, output, page;
  std::string part;  // computes only the parts whose names begin with it
  bool quick = false;
  experiments::CompletenessOptions completeness;  // for the experiment of that name
  std::string seeds, scene_options, dense_options, work;
};

// The options of ReproducePaper, bound to `a`.
ProgramOptions describe(Arguments& a);

// Whether the experiment is `completeness`. Its tables are also printed.
bool is_completeness(const Arguments& a);

// Warns of each option that has no effect on the experiment.
void warn_of_no_effect(const Arguments& a, const ParsedOptions& parsed);

// The experiment of `a`, or all experiments. Error that names the option and its value.
std::vector<experiments::Experiment> chosen_experiments(const Arguments& a,
                                                        const CommonOptions& common);

// The folder of all results. A quick run has its own folder inside the output folder, so that it
// neither removes files of a full run nor replaces its results.
std::filesystem::path results_folder(const Arguments& a, const CommonOptions& common);

// The folder of an experiment's intermediate files, which is removed when the experiment is
// finished.
std::filesystem::path work_folder(const Arguments& a, const CommonOptions& common,
                                  const std::string& experiment);

}  // namespace axial::apps
