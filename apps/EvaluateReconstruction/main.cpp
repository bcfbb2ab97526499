// SPDX-License-Identifier: GPL-3.0-or-later
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/parallel.h"
#include "io/json.h"
#include "options.h"
#include "runs.h"

using namespace axial;

namespace {

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  const ThreadLimit threads(options.parsed.common.max_threads);
  const bool is_depth_map = options.input.extension() == ".dmap";
  nlohmann::ordered_json report{{"input", options.input.string()},
                                {"truth", options.truth.string()}};
  report.update(is_depth_map ? run_depth_map(options) : run_cloud(options));
  if (!options.json.empty()) write_atomically(options.json, io::to_text(report, 1) + "\n");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return run_program("EvaluateReconstruction", [&] { return run(argc, argv); });
}
