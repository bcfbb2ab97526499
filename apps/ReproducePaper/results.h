// SPDX-License-Identifier: GPL-3.0-or-later
// An experiment's numbers in a folder: finished parts are found there again.
#pragma once

#include <filesystem>

#include "base/progress.h"
#include "experiments/experiment.h"

namespace axial {

// Computes the parts that `folder`/parts/<experiment> does not hold yet, each written there as soon
// as it is finished. A part counts as finished if its file is whole and names the same inputs.
experiments::Json computed_results(const experiments::Experiment& experiment, bool quick,
                                   const std::filesystem::path& folder,
                                   const ProgressSink& progress);

}  // namespace axial
