// SPDX-License-Identifier: GPL-3.0-or-later
// Repeats the paper's experiments: numbers as JSON, and from these its figures and tables.
#include <spdlog/spdlog.h>

#include "base/atomic_file.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "options.h"
#include "page.h"
#include "results.h"

using namespace axial;

namespace {

void reproduce(const experiments::Experiment& experiment, const Arguments& arguments,
               const CommonOptions& common) {
  const std::filesystem::path folder = in_working_folder(common, arguments.output);
  const experiments::Json results =
      computed_results(experiment, arguments.quick, folder, console_progress(experiment.name));
  write_atomically(folder / (experiment.name + ".json"), results.dump() + "\n");
  const auto documents = experiment.documents(results);
  for (const experiments::Document& document : documents)
    write_atomically(folder / document.file, document.text);
  std::filesystem::remove_all(work_folder(arguments, common, experiment.name));
  if (!arguments.page.empty()) update_page(in_working_folder(common, arguments.page), documents);
  spdlog::info("{}: {} parts in {}", experiment.name, experiment.parts.size(), folder.string());
}

}  // namespace

int main(int argc, char** argv) {
  return run_program("ReproducePaper", [&] {
    Arguments arguments;
    const ParsedOptions parsed = parse_options(argc, argv, describe(arguments));
    if (!parsed.run) return parsed.exit_code;
    const auto experiments = chosen_experiments(arguments, parsed.common);
    const ThreadLimit limit(parsed.common.max_threads);
    for (const experiments::Experiment& experiment : experiments)
      reproduce(experiment, arguments, parsed.common);
    return 0;
  });
}
