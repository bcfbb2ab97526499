// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <numbers>

#include "base/error.h"
#include "base/version.h"
#include "io/images/bit_depth.h"

namespace axial::apps {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

calibrate::Board board_of(const std::string& text) {
  try {
    return calibrate::parse_board(text);
  } catch (const Error& error) {
    fail("--board {}", error.text());
  }
}

void declare_files(OptionList& visible, Options& options) {
  visible
      .add("input-file,i", &options.input,
           "photographs of the board under water: a folder, or a file; may be given several times")
      .add("lens", &options.lens,
           "lens calibrated in air: COLMAP's cameras.txt or cameras.bin with one camera, or "
           "Calibmar's calibration.yaml")
      .required("the lens calibrated in air")
      .add("housing", &options.housing,
           "approximate port: a housing file or a calibration.yaml (default: the port in the file "
           "of --lens)")
      .add("port", &options.port,
           "name of the port in the housing file (default: the port of the camera there, else the "
           "file's default port)")
      .add_text(
          "board", [&](const std::string& text) { options.board = board_of(text); },
          "the board, with columns, rows and lengths in metres: checkerboard:9x6:0.03 (inner "
          "corners, square; 0.03,0.0298: width and height of a square), charuco:8x6:0.03:0.02 "
          "(squares, square, marker) or "
          "apriltags:5x4:0.03:0.01 (tags, tag, gap); charuco and apriltags may end in :DICTIONARY")
      .required("the board in the photographs")
      .add("output-file,o", &options.output, "housing file to write (.json)")
      .output_file()
      .required("the housing file to write")
      .add("calibmar", &options.calibmar, "also write a calibration.yaml for Calibmar")
      .output_file()
      .add("report", &options.report, "write all results to this file (.json)")
      .output_file()
      .add("coverage", &options.coverage,
           "draw the corners' positions in the images to this file (.svg)")
      .output_file();
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
      .positive()
      .add_with_default(
          "max-distance-sigma", &options.limits.place,
          "fail if the standard deviation of the distance, or of a dome's centre, is larger [m]")
      .positive()
      .add_with_default("max-normal-sigma", &max_normal_degrees,
                        "fail if the standard deviation of the normal is larger [degrees]")
      .positive()
      .add_with_default("max-index-sigma", &options.limits.index,
                        "fail if the standard deviation of the water's index is larger")
      .positive()
      .add_with_default("max-thickness-sigma", &options.limits.thickness,
                        "fail if the standard deviation of the thickness is larger [m]")
      .positive();
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  double max_normal_degrees = 0.1;
  ProgramOptions program{"CalibrateHousing",
                         "calibrates the port of a housing from photographs of a board under water",
                         {},
                         {}};
  program.version = version_line(program.name);
  // In the order of --help.
  declare_files(program.visible, options);
  declare_estimate(program.visible, options, max_normal_degrees);
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  options.limits.normal = max_normal_degrees * kDegree;
  return options;
}

}  // namespace axial::apps
