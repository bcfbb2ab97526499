// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/setting_names.h"
#include "base/version.h"
#include "io/images/bit_depth.h"

namespace axial::apps {
namespace {

// The options as text, before they are checked.
struct Texts {
  std::vector<std::string> input;
  std::string lens, housing, board, output, calibmar, report, coverage;
};

constexpr double kDegree = std::numbers::pi / 180;

void declare_files(OptionList& visible, Options& options, Texts& texts) {
  visible
      .add("input-file,i", &texts.input,
           "photographs of the board under water: a folder, or a file; may be given several times")
      .add("lens", &texts.lens,
           "lens calibrated in air: COLMAP's cameras.txt or cameras.bin with one camera, or "
           "Calibmar's calibration.yaml")
      .add("housing", &texts.housing,
           "approximate port: a housing file or a calibration.yaml (default: the port in the file "
           "of --lens)")
      .add("port", &options.port,
           "name of the port in the housing file (default: the port of the camera there, else the "
           "file's default port)")
      .add("board", &texts.board,
           "the board, with columns, rows and lengths in metres: checkerboard:9x6:0.03 (inner "
           "corners, square; 0.03,0.0298: width and height of a square), charuco:8x6:0.03:0.02 "
           "(squares, square, marker) or "
           "apriltags:5x4:0.03:0.01 (tags, tag, gap); charuco and apriltags may end in :DICTIONARY")
      .add("output-file,o", &texts.output, "housing file to write (.json)")
      .add("calibmar", &texts.calibmar, "also write a calibration.yaml for Calibmar")
      .add("report", &texts.report, "write all results to this file (.json)")
      .add("coverage", &texts.coverage,
           "draw the corners' positions in the images to this file (.svg)");
}

// What is estimated, from which corners, and how precisely it must be known.
void declare_estimate(OptionList& visible, Options& options, double& max_normal_degrees) {
  visible.add("refine", &options.refine_list,
              "values to estimate: any of normal, distance (flat ports), centre (domes), thickness "
              "(of the glass), index (of the water) (default: normal,distance or centre)");
  io::declare_bit_depth(visible, options.bit_depth);
  pose::declare_sigmas(visible, options.sigmas);
  visible
      .add_with_default("max-error", &options.calibrate.max_error,
                        "corners with larger errors are dropped [px]")
      .add_with_default(
          "max-distance-sigma", &options.limits.place,
          "fail if the standard deviation of the distance, or of a dome's centre, is larger [m]")
      .add_with_default("max-normal-sigma", &max_normal_degrees,
                        "fail if the standard deviation of the normal is larger [degrees]")
      .add_with_default("max-index-sigma", &options.limits.index,
                        "fail if the standard deviation of the water's index is larger")
      .add_with_default("max-thickness-sigma", &options.limits.thickness,
                        "fail if the standard deviation of the thickness is larger [m]");
}

void require_positive(const char* option, double value) {
  if (!(value > 0 && std::isfinite(value))) fail("--{} {}: must be positive", option, value);
}

void check(const Options& options, double max_normal_degrees) {
  if (options.lens.empty()) fail("--lens is missing: the lens calibrated in air");
  if (options.output.empty()) fail("--output-file is missing: the housing file to write");
  io::check_bit_depth(options.bit_depth, option_of("bit_depth"));
  require_positive("max-error", options.calibrate.max_error);
  require_positive("max-distance-sigma", options.limits.place);
  require_positive("max-normal-sigma", max_normal_degrees);
  require_positive("max-index-sigma", options.limits.index);
  require_positive("max-thickness-sigma", options.limits.thickness);
}

}  // namespace

std::string option_of(std::string_view setting) {
  constexpr SettingName kOptions[] = {{"refine", "--refine"},
                                      {"normal_sigma", "--normal-sigma"},
                                      {"distance_sigma", "--distance-sigma"},
                                      {"centre_sigma", "--centre-sigma"},
                                      {"thickness_sigma", "--thickness-sigma"},
                                      {"index_sigma", "--index-sigma"},
                                      {"bit_depth", "--bit-depth"}};
  return name_in(kOptions, setting);
}

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  Texts texts;
  double max_normal_degrees = 0.1;
  ProgramOptions program{"CalibrateHousing",
                         "calibrates the port of a housing from photographs of a board under water",
                         {},
                         {}};
  program.version = version_line(program.name);
  // In the order of --help.
  declare_files(program.visible, options, texts);
  declare_estimate(program.visible, options, max_normal_degrees);
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  const auto path = [&](const std::string& text) {
    return in_working_folder(options.parsed.common, text);
  };
  const auto output = [&](const std::string& text, const char* option) {
    return output_in_working_folder(options.parsed.common, text, option);
  };
  for (const std::string& input : texts.input) options.input.push_back(path(input));
  options.lens = path(texts.lens);
  options.housing = path(texts.housing);
  options.output = output(texts.output, "--output-file");
  options.calibmar = output(texts.calibmar, "--calibmar");
  options.report = output(texts.report, "--report");
  options.coverage = output(texts.coverage, "--coverage");
  options.limits.normal = max_normal_degrees * kDegree;
  check(options, max_normal_degrees);
  if (texts.board.empty()) fail("--board is missing: the board in the photographs");
  try {
    options.board = calibrate::parse_board(texts.board);
  } catch (const Error& error) {
    fail("--board {}", error.what());
  }
  return options;
}

}  // namespace axial::apps
