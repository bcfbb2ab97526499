// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/program.h"
#include "experiments/experiment.h"

namespace axial {

struct Arguments {
  std::string experiment, output, page;
  bool quick = false;
};

// The options of ReproducePaper, bound to `a`.
ProgramOptions describe(Arguments& a);

// The experiment that was asked for, or all. Error that names the option and its value.
std::vector<experiments::Experiment> chosen_experiments(const Arguments& a,
                                                        const CommonOptions& common);

// Where the experiments of `a` keep intermediate files until they are finished.
std::filesystem::path work_folder(const Arguments& a, const CommonOptions& common,
                                  const std::string& experiment);

}  // namespace axial
