// SPDX-License-Identifier: GPL-3.0-or-later
// Stores the results of an experiment in a folder, and finds finished parts in this folder.
#pragma once

#include <filesystem>
#include <vector>

#include "base/progress.h"
#include "experiments/experiment.h"

namespace axial::experiments {

// Returns the parts of the experiment whose names begin with `beginning`, in their order. If
// `beginning` is empty: all parts.
std::vector<Part> chosen_parts(const Experiment& experiment, const std::string& beginning);

// Computes those of `parts` that are not finished, one after the other. `experiment`: name of the
// experiment. A part is finished if `folder`/parts/<experiment> contains a complete file of the
// part with the same inputs. Writes the file of each part as soon as the part is computed, and the
// computation time into a second file beside it. `progress` gets the number of parts that are
// finished so far, and the number of `parts`. If the computation of a part throws an exception, the
// exception is passed on, and the parts before it stay finished. Throws an Error that names the
// folder or file if it cannot be written.
void compute(const std::string& experiment, const std::vector<Part>& parts,
             const std::filesystem::path& folder, const ProgressSink& progress);

// Returns all stored results of the experiment as an object with the fields "experiment" (the
// name), "quick" (the argument) and "parts". The field "parts" is an object with a field for each
// part, by its name: an object with the fields "inputs" (Part::inputs) and "result" (the return
// value of Part::compute). `folder`: as for compute(). Returns null unless all parts are finished.
Json kept_results(const Experiment& experiment, bool quick, const std::filesystem::path& folder);

// Wall-clock times [s] of the computations of the parts, on the machines that computed the parts.
struct PartTimes {
  std::size_t parts = 0;        // number of parts with a known time
  double sum = 0, longest = 0;  // over these parts [s]; 0 without such parts
  std::string longest_part;     // name of the part with the longest time; empty without such parts
};
// Returns the stored times of those parts of the experiment that have one. `folder`: as for
// compute().
PartTimes part_times(const Experiment& experiment, const std::filesystem::path& folder);

}  // namespace axial::experiments
