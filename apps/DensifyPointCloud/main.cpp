// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>

#include "axial/densify.h"
#include "base/log.h"
#include "base/memory.h"
#include "options.h"
#include "without_effect.h"

namespace axial::apps {
namespace {

// OpenMVS's programs do not know ports or distortion, and report no error for scenes that have
// them.
void say_who_may_read(const densify::Report& report, const Options& options) {
  if (report.only_pinholes) return;
  const std::filesystem::path name = options.settings.output.scene.filename();
  const std::filesystem::path& exported = options.settings.output.pinhole_export;
  const std::string folder = exported.empty() ? "DIR" : exported.filename().string();
  log_info(
      "{} has cameras behind ports or with distorted lenses, which OpenMVS treats as pinholes: its "
      "ReconstructMesh can use {} and the cloud, but RefineMesh, TextureMesh and fusion of the "
      "depth maps give wrong results; --pinhole-export {} writes files that all of OpenMVS's "
      "programs can use",
      name.string(), name.string(), folder);
}

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  share_one_heap();
  const densify::Report report = densify::densify(
      options.settings,
      [&](const densify::SceneFacts& facts) { warn_of_options_without_effect(options, facts); },
      program_context(options.parsed));
  say_who_may_read(report, options);
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("DensifyPointCloud", [&] { return axial::apps::run(argc, argv); });
}
