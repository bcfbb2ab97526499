// SPDX-License-Identifier: GPL-3.0-or-later
// Repeats the paper's experiments: writes their numbers as JSON. docs/paper/documents.py makes
// figures and tables from the numbers.
#include "base/atomic_file.h"
#include "base/log.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "experiments/results.h"
#include "io/bytes/json.h"
#include "options.h"

namespace axial::apps {
namespace {

void reproduce(const experiments::Experiment& experiment, const Arguments& arguments) {
  const std::filesystem::path folder = results_folder(arguments);
  experiments::compute(experiment.name, experiments::chosen_parts(experiment, arguments.part),
                       folder, console_progress(experiment.name));
  const experiments::Json results = experiments::kept_results(experiment, arguments.quick, folder);
  if (results.is_null()) {
    log_info("{}: other parts are not computed yet", experiment.name);
    return;
  }
  write_atomically(folder / (experiment.name + ".json"), io::to_text(results) + "\n");
  std::filesystem::remove_all(work_folder(arguments, experiment.name));
  log_info("{}: {} parts in {}", experiment.name, experiment.parts.size(), folder.string());
}

void log_times(const std::vector<experiments::Experiment>& experiments,
               const std::filesystem::path& folder) {
  log_info("{:<16} {:>5} {:>9} {:>11}  {}", "experiment", "parts", "time [s]", "longest [s]",
           "longest part");
  for (const experiments::Experiment& experiment : experiments) {
    const experiments::PartTimes times = experiments::part_times(experiment, folder);
    log_info("{:<16} {:>5} {:>9.1f} {:>11.1f}  {}", experiment.name, times.parts, times.sum,
             times.longest, times.longest_part);
  }
}

int run(int argc, char** argv) {
  Arguments arguments;
  const ParsedOptions parsed = parse_options(argc, argv, describe(arguments));
  if (!parsed.run) return parsed.exit_code;
  warn_of_no_effect(arguments, parsed);
  const auto experiments = chosen_experiments(arguments, parsed.common);
  const ThreadLimit limit(parsed.common.max_threads);
  for (const experiments::Experiment& experiment : experiments) reproduce(experiment, arguments);
  log_times(experiments, results_folder(arguments));
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("ReproducePaper", [&] { return axial::apps::run(argc, argv); });
}
