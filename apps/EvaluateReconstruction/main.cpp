// SPDX-License-Identifier: GPL-3.0-or-later
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/files_in.h"
#include "base/same_file.h"
#include "io/bytes/json.h"
#include "io/colmap/colmap.h"
#include "io/textured/textured_mesh.h"
#include "options.h"
#include "runs.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> inputs_of(const Options& options) {
  std::vector<fs::path> inputs{options.housing};
  for (const fs::path& model : {options.input, options.truth})
    for (const fs::path& file : io::files_of_mesh(model)) inputs.push_back(file);
  for (const fs::path& model : {options.cameras_model, options.estimated_model})
    if (!model.empty())
      for (const fs::path& file : files_in(model)) inputs.push_back(file);
  return inputs;
}

// Called before the work.
void check_outputs(const Options& options) {
  const std::vector<fs::path> inputs = inputs_of(options);
  const NamedOutput outputs[] = {{"--json", options.json},
                                 {"--error-cloud", options.error_cloud},
                                 {"--error-mesh", options.error_mesh},
                                 {"--picture", options.picture},
                                 {"--aligned", options.aligned},
                                 {"--transform-out", options.transform}};
  require_different(outputs);
  for (const auto& [option, path] : outputs) {
    if (path.empty()) continue;
    require_not_an_input(path, inputs, option);
    require_writable(path);
  }
}

// Called once, because it logs which of several models is read.
void find_models(Options& options, const Context& context) {
  if (!options.cameras.empty())
    options.cameras_model = io::find_colmap_model(options.cameras, context);
  if (!options.estimated.empty())
    options.estimated_model = io::find_colmap_model(options.estimated, context);
}

int run(int argc, char** argv) {
  Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  const Context context = program_context(options.parsed);
  find_models(options, context);
  check_outputs(options);
  const bool is_depth_map = options.input.extension() == ".dmap";
  nlohmann::ordered_json report{{"input", options.input.filename().string()}};
  if (!options.truth.empty()) report["truth"] = options.truth.filename().string();
  if (is_depth_map)
    report.update(run_depth_map(options, context));
  else
    report.update(options.truth.empty() ? run_rendering(options, context)
                                        : run_cloud(options, context));
  if (!options.json.empty()) write_atomically(options.json, io::to_text(report, 1) + "\n");
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("EvaluateReconstruction", [&] { return axial::apps::run(argc, argv); });
}
