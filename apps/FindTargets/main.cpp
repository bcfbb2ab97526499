// SPDX-License-Identifier: GPL-3.0-or-later
// Finds coded targets in photographs, and draws targets to print.

#include <fmt/format.h>

#include <map>

#include "base/atomic_file.h"
#include "base/console.h"
#include "base/context.h"
#include "base/first_error.h"
#include "base/log.h"
#include "base/parallel.h"
#include "base/program.h"
#include "io/images/image.h"
#include "options.h"
#include "photographs.h"
#include "pictures.h"
#include "targets/find_targets.h"
#include "targets/print.h"
#include "targets/targets_file.h"

namespace axial::apps {
namespace {

void draw(const Options& options) {
  const targets::Family& family = options.families.front();
  require_writable_folder(options.print);
  write_folder(options.print, [&](const std::filesystem::path& folder) {
    for (const std::size_t number : options.plates)
      write_atomically(folder / fmt::format("plate-{}.svg", number),
                       targets::plate_svg(family, number, options.side));
    for (const Bar& bar : options.bars)
      write_atomically(folder / fmt::format("bar-{}-{}.svg", bar.first, bar.second),
                       targets::bar_svg(family, bar.first, bar.second, options.side, bar.length));
  });
  log_info("{} plates and {} bars in {}; measure them after printing", options.plates.size(),
           options.bars.size(), options.print.string());
}

// Two plates with one code cannot be told apart.
void warn_of_repetitions(const targets::Photograph& photograph) {
  std::map<std::string, int> places;
  for (const targets::Detection& target : photograph.targets) ++places[target.label];
  for (const auto& [label, count] : places)
    if (count > 1)
      log_warning("{}: shows {} at {} places; each label must be on one plate only",
                  photograph.name, label, count);
}

targets::Photograph find(const NamedPhotograph& photograph, const Options& options) {
  const cv::Mat pixels = io::read_photograph(photograph.file).pixels;
  targets::Photograph found{photograph.name, pixels.size(),
                            targets::find_targets(pixels, options.families)};
  if (!options.pictures.empty())
    write_pictures(options.pictures, io::in_8_bits(pixels, io::bits_used(pixels)), found);
  return found;
}

// Memory grows with the photographs in flight: a few.
std::vector<targets::Photograph> find_all(const std::vector<NamedPhotograph>& photographs,
                                          const Options& options) {
  std::vector<targets::Photograph> found(photographs.size());
  const Context console(console_events());
  ProgressCounter done(console.stage("Searched photographs"), photographs.size());
  FirstError error;
  parallel_for(photographs.size(), [&](std::size_t i) {
    error.run(i, [&] { found[i] = find(photographs[i], options); });
    done.add();
  });
  error.rethrow();
  return found;
}

void report(const std::vector<targets::Photograph>& found) {
  std::map<std::string, std::size_t> photographs_with;
  std::size_t all = 0;
  for (const targets::Photograph& photograph : found) {
    warn_of_repetitions(photograph);
    for (const targets::Detection& target : photograph.targets)
      ++photographs_with[target.label], ++all;
  }
  log_info("{} targets at {} places in {} photographs", photographs_with.size(), all, found.size());
  for (const auto& [label, count] : photographs_with)
    if (count == 1) log_info("{}: is in one photograph only, so it has no place in space", label);
}

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  if (!options.print.empty()) {
    draw(options);
    return 0;
  }
  const ThreadLimit threads(options.parsed.common.max_threads);
  const std::vector<NamedPhotograph> photographs = photographs_of(options.input);
  require_writable(options.output);
  if (!options.pictures.empty()) make_folder(options.pictures);
  const std::vector<targets::Photograph> found = find_all(photographs, options);
  targets::write_targets(options.output, options.families, found);
  report(found);
  log_info("Targets in {}", options.output.string());
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("FindTargets", [&] { return axial::apps::run(argc, argv); });
}
