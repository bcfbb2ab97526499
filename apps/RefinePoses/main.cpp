// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/error.h"
#include "base/log.h"
#include "effective_lens.h"
#include "found_targets.h"
#include "pose/adjust/uncertainty.h"
#include "stages.h"

namespace axial::apps {
namespace {

// Tells the errors, judges the result, and writes it.
void finish(const Options& options, const Input& input, const Refined& refined,
            const UnusedInput& unused, const std::optional<Registered>& registered,
            const Context& context) {
  const bool scale_lost = !unused.lines().empty() && !options.refine.adjust.know_lengths();
  if (scale_lost) log_warning("The model has no scale: --scale-from is not used");
  Results results{refined.report,
                  errors_by_image(refined.before, refined.after.bundle),
                  refined.after.bundle,
                  refined.after.ports,
                  options.refine.adjust,
                  unused.lines(),
                  scale_lost};
  for (const std::string& line : error_lines(results)) log_info("{}", line);
  for (const std::string& line : position_lines(refined.report)) log_info("{}", line);
  for (const std::string& line : options.dropped_positions)
    results.unused.push_back("--scale-from: " + line);
  if (registered) results.registered = &*registered;
  judge(options, refined, results);
  const pose::Uncertainty known = write(options, input, refined, results, context);
  for (const std::string& line : uncertainty_lines(results, known)) log_info("{}", line);
  for (const std::string& line : rig_lines(refined.after.bundle, known)) log_info("{}", line);
  if (!results.options.poses_known) {
    log_info("{}", shape_line(known));
    log_info("{}", depth_line(known));
  }
  if (results.control) {
    for (const std::string& line : control_lines(*results.control)) log_info("{}", line);
    for (const std::string& line : control_warnings(*results.control)) log_warning("{}", line);
  }
  for (const std::string& line : rig_warnings(refined.after.bundle, known)) log_warning("{}", line);
  judge_numbers(known, results);
}

int run(int argc, char** argv) {
  Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  const Context context = program_context(options.parsed);
  if (!options.effective_lens.empty()) {
    write_effective_lenses(options, context);
    return 0;
  }
  Input input = read_input(options, context);
  check_output(options, input);
  if (options.control.find) find_targets(options, input, context);
  const std::optional<Registered> registered = register_photographs(options, input, context);
  UnusedInput unused(options.allow_missing);
  const Refined refined = refine(options, input, unused, context);
  finish(options, input, refined, unused, registered, context);
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("RefinePoses", [&] { return axial::apps::run(argc, argv); });
}
