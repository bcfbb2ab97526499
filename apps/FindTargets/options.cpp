// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <algorithm>

#include "base/error.h"
#include "base/file_extension.h"
#include "base/parse_number.h"
#include "base/same_file.h"
#include "base/split.h"
#include "base/version.h"
#include "targets/target_table.h"

namespace axial::apps {
namespace {

template <class T>
T number_in(std::string_view word, const char* option, const std::string& text) {
  const auto number = parse_number<T>(word);
  if (!number) fail("--{} {}: '{}' is not a number", option, text, word);
  return *number;
}

// "1-4,9": numbers and ranges of numbers.
std::vector<std::size_t> numbers_of(const std::string& text) {
  constexpr std::size_t kMost = 1'000'000;
  std::vector<std::size_t> numbers;
  for (const std::string_view word : split(text, ',')) {
    const auto ends = split(word, '-');
    if (ends.empty() || ends.size() > 2) fail("--plates {}: '{}' is not a range", text, word);
    const auto first = number_in<std::size_t>(ends.front(), "plates", text);
    const auto last = number_in<std::size_t>(ends.back(), "plates", text);
    if (last < first || last > kMost) fail("--plates {}: '{}' is not a range", text, word);
    for (std::size_t number = first; number <= last; ++number) numbers.push_back(number);
  }
  return numbers;
}

// "1,2,0.5": two targets and a length; several bars are separated by semicolons.
std::vector<Bar> bars_of(const std::string& text) {
  std::vector<Bar> bars;
  for (const std::string_view bar : split(text, ';')) {
    const auto words = split(bar, ',');
    if (words.size() != 3) fail("--bars {}: '{}' is not TARGET,TARGET,LENGTH", text, bar);
    bars.push_back({number_in<std::size_t>(words[0], "bars", text),
                    number_in<std::size_t>(words[1], "bars", text),
                    number_in<double>(words[2], "bars", text)});
    if (!(bars.back().length > 0 && bars.back().length <= 100))
      fail("--bars {}: the length {} m must be above 0 and at most 100", text, words[2]);
  }
  return bars;
}

void declare_print(OptionList& list, Options& options) {
  list.add("print", &options.print,
           "draw plates and bars to scale into this folder (.svg), and stop")
      .output_folder()
      .add_text(
          "plates", [&](const std::string& text) { options.plates = numbers_of(text); },
          "numbers of the plates to draw: 1-4,9")
      .add_text(
          "bars", [&](const std::string& text) { options.bars = bars_of(text); },
          "scale bars to draw, with the distance of the centres [m]: 1,2,0.5;3,4,0.5")
      .add_with_default("side", &options.side, "side of the plates to draw [m]")
      .range(0.005, 10);
}

void declare(OptionList& list, Options& options) {
  options.families = targets::parse_families(targets::kUsualFamilies);
  list.add("input-file,i", &options.input,
           "photographs: a folder, with its subfolders, or a file; may be given several times")
      .add("output-file,o", &options.output,
           "file to write: targets with image, x, y and sigma [px] (.json); OpenDroneMap's "
           "gcp_list.txt (.txt), which needs --control; Metashape's markers (.xml)")
      .output_file()
      .add("control", &options.control,
           "points and scale bars whose places and lengths are known, for .txt and .xml: a file of "
           "ReefShape, Metashape or OpenDroneMap, or JSON; may be given several times")
      .add_with_default("epsg", &options.epsg,
                        "EPSG code of the projected system, in metres, for the points of --control "
                        "(0: the system that the file states, or UTM for longitude and latitude)")
      .zero_or(1024, 999'999)
      .add_text_with_default(
          "families", targets::kUsualFamilies,
          [&](const std::string& text) { options.families = targets::parse_families(text); },
          "targets to find, at most one of each kind: circular12, circular14, circular16 or "
          "circular20; a dictionary of OpenCV's markers (APRILTAG_36h11, 4X4_50, ...); a ChArUco "
          "board, charuco:COLUMNSxROWS:SQUARE:MARKER[:DICTIONARY]")
      .add(
          "target-table", &options.target_table,
          "labels of the targets, for plates of other programs: lines CODE,LABEL; needs --families "
          "with one family")
      .add("pictures", &options.pictures,
           "also write a picture of each target to this folder, a subfolder for each photograph")
      .output_folder();
  declare_print(list, options);
  list.add_max_memory();
}

// Each number is on one plate only.
void require_different_targets(const Options& options) {
  std::vector<std::size_t> numbers = options.plates;
  for (const Bar& bar : options.bars) {
    numbers.push_back(bar.first);
    numbers.push_back(bar.second);
  }
  std::ranges::sort(numbers);
  const auto same = std::ranges::adjacent_find(numbers);
  if (same != numbers.end())
    fail("--print: target {} would be drawn twice; each number must be on one plate only", *same);
}

void check_control(const Options& options) {
  const bool holds_control = format_of(options.output) != OutputFormat::json;
  if (!options.control.empty() && !holds_control)
    fail("--control: is for an output file .txt or .xml, but --output-file is {}",
         options.output.string());
  if (options.control.empty() && given(options.parsed, "epsg"))
    fail("--epsg: needs --control, the file of points");
  if (options.control.empty() && format_of(options.output) == OutputFormat::gcp_list)
    fail("--output-file {}: gcp_list.txt needs --control, the places of the targets",
         options.output.string());
  require_not_an_input(options.output, options.control, "--output-file");
}

void check(const Options& options) {
  if (!options.print.empty()) {
    if (!options.input.empty()) fail("--print: draws plates and reads no photographs");
    for (const char* of_photographs :
         {"output-file", "pictures", "control", "epsg", "target-table"})
      if (given(options.parsed, of_photographs))
        fail("--{}: is for photographs, but --print draws plates and stops", of_photographs);
    require_different_targets(options);
    if (options.plates.empty() && options.bars.empty())
      fail("--print: needs --plates or --bars, the targets to draw");
    if (options.families.size() == 1 && options.families.front().kind == targets::Kind::board)
      fail("--print: draws plates and bars, but --families is a board");
    if (options.families.size() != 1)
      fail("--print: needs --families with one family, that of the targets to draw");
    return;
  }
  if (!options.plates.empty()) fail("--plates: needs --print, the folder for the drawings");
  if (!options.bars.empty()) fail("--bars: needs --print, the folder for the drawings");
  if (given(options.parsed, "side")) fail("--side: needs --print, the folder for the drawings");
  if (options.output.empty()) fail("--output-file is required");
  require_not_an_input(options.output, options.input, "--output-file");
  check_control(options);
}

void read_table(Options& options) {
  if (options.families.size() != 1 || options.families.front().kind == targets::Kind::board)
    fail("--target-table: needs --families with one family, that of the codes");
  targets::read_target_table(options.target_table, options.families.front());
}

}  // namespace

OutputFormat format_of(const std::filesystem::path& output) {
  const std::string extension = lower_extension(output);
  if (extension == ".txt") return OutputFormat::gcp_list;
  return extension == ".xml" ? OutputFormat::markers : OutputFormat::json;
}

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  ProgramOptions program{
      "FindTargets", "finds coded targets in photographs, and draws targets to print", {}, {}};
  program.version = version_line(program.name);
  program.instead_of_input = "print";
  declare(program.visible, options);
  options.parsed = parse_options(argc, argv, program);
  if (options.parsed.run) check(options);
  if (options.parsed.run && !options.target_table.empty()) read_table(options);
  return options;
}

}  // namespace axial::apps
