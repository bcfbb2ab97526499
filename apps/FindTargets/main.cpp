// SPDX-License-Identifier: GPL-3.0-or-later
// Finds coded targets in photographs, and draws targets to print.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "base/atomic_file.h"
#include "base/context.h"
#include "base/error.h"
#include "base/log.h"
#include "base/program/program.h"
#include "base/same_file.h"
#include "io/images/image.h"
#include "options.h"
#include "photographs.h"
#include "pictures.h"
#include "targets/print.h"
#include "targets/search.h"
#include "targets/targets_file.h"
#include "targets_output.h"

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

// The photographs are read again, so that few are in memory at a time.
void write_all_pictures(const std::filesystem::path& folder,
                        const std::vector<targets::NamedPhotograph>& photographs,
                        const std::vector<targets::Photograph>& found) {
  write_folder(folder, [&](const std::filesystem::path& staging) {
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i].targets.empty()) continue;
      const cv::Mat pixels = io::read_photograph(photographs[i].file).pixels;
      write_pictures(staging, io::in_8_bits(pixels, io::bits_used(pixels)), found[i]);
    }
  });
}

void report(const std::vector<targets::Photograph>& found) {
  std::map<std::pair<std::size_t, std::string>, std::set<std::string>> photographs;
  std::size_t places = 0;
  for (const targets::Photograph& photograph : found) {
    warn_of_repetitions(photograph);
    for (const targets::Detection& target : photograph.targets) {
      photographs[{target.number, target.label}].insert(photograph.name);
      ++places;
    }
  }
  log_info("{} targets at {} places in {} photographs", photographs.size(), places, found.size());
  for (const auto& [target, in] : photographs)
    if (in.size() == 1)
      log_info("{}: is in {} only, so it has no place in space", target.second, *in.begin());
}

// Pictures in the folder of the photographs would be searched by the next run.
void check_outputs(const Options& options,
                   const std::vector<targets::NamedPhotograph>& photographs) {
  for (const targets::NamedPhotograph& photograph : photographs)
    require_not_an_input(options.output, std::array{photograph.file}, "--output-file");
  for (const std::filesystem::path& input : options.input) {
    const std::string below = options.pictures.lexically_relative(input).string();
    if (!options.pictures.empty() && !below.empty() && !below.starts_with(".."))
      fail("--pictures {}: lies in the folder of the photographs, {}", options.pictures.string(),
           input.string());
  }
  require_writable(options.output);
  if (!options.pictures.empty()) require_writable_folder(options.pictures);
}

int run(int argc, char** argv) {
  const Options options = parse_command_line(argc, argv);
  if (!options.parsed.run) return options.parsed.exit_code;
  if (!options.print.empty()) {
    draw(options);
    return 0;
  }
  const Context context = program_context(options.parsed);
  const std::vector<targets::NamedPhotograph> photographs = photographs_of(options.input);
  check_outputs(options, photographs);
  control::Control known = read_known(options);
  const std::vector<targets::Photograph> found =
      targets::search_photographs(photographs, options.families, context);
  write_output(options, found, std::move(known));
  if (!options.pictures.empty()) write_all_pictures(options.pictures, photographs, found);
  report(found);
  log_info("Targets in {}", options.output.string());
  return 0;
}

}  // namespace
}  // namespace axial::apps

int main(int argc, char** argv) {
  return axial::run_program("FindTargets", [&] { return axial::apps::run(argc, argv); });
}
