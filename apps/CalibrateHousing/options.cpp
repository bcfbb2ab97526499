// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <cmath>
#include <numbers>

#include "base/error.h"

namespace po = boost::program_options;
using axial::fail;

namespace {

// The options as text, before they are checked.
struct Texts {
  std::vector<std::string> input;
  std::string lens, housing, board, output, calibmar, report, coverage;
};

constexpr double kDegree = std::numbers::pi / 180;

void declare(po::options_description& visible, Options& options, Texts& texts,
             double& max_normal_degrees) {
  visible.add_options()  //
      ("input-file,i", po::value(&texts.input)->composing(),
       "photographs of the board under water: a folder, or a file; may be given several times")  //
      ("lens", po::value(&texts.lens),
       "the lens as calibrated in air: cameras.txt or cameras.bin of COLMAP, with one camera, or "
       "Calibmar's calibration.yaml")  //
      ("housing", po::value(&texts.housing),
       "the port as far as it is known: a housing file or a calibration.yaml; default: that in "
       "the lens's file")  //
      ("port", po::value(&options.port),
       "the port to calibrate, by its name in the housing file; default: the camera's own there, "
       "else the default one")  //
      ("board", po::value(&texts.board),
       "columns, rows and metres: checkerboard:9x6:0.03 (inner corners, square), "
       "charuco:8x6:0.03:0.02 (squares, square, marker) or apriltags:5x4:0.03:0.01 (tags, tag, "
       "gap); the last two may end in :DICTIONARY")                                           //
      ("output-file,o", po::value(&texts.output), "housing file to write (.json)")            //
      ("calibmar", po::value(&texts.calibmar), "also write a calibration.yaml for Calibmar")  //
      ("report", po::value(&texts.report), "write all numbers there (.json)")                 //
      ("coverage", po::value(&texts.coverage), "draw where corners were seen (.svg)")         //
      ("refine", po::value(&options.refine_list),
       "what is unknown: any of normal, distance (flat ports), centre (domes), thickness (of the "
       "glass), index (of the water); default: normal,distance or centre");
  axial::pose::Sigmas& sigmas = options.sigmas;
  visible.add_options()  //
      ("normal-sigma", po::value(&sigmas.normal_degrees)->default_value(0),
       "how well the normal was measured [degrees]; 0: not at all")                          //
      ("distance-sigma", po::value(&sigmas.distance)->default_value(0), "the distance [m]")  //
      ("centre-sigma", po::value(&sigmas.centre)->default_value(0), "a dome's centre [m]")   //
      ("thickness-sigma", po::value(&sigmas.thickness)->default_value(0),
       "the thickness of the glass [m]")                                                //
      ("index-sigma", po::value(&sigmas.index)->default_value(0), "the water's index")  //
      ("max-error", po::value(&options.calibrate.max_error)->default_value(4),
       "corners with larger errors are dropped [px]")  //
      ("max-distance-sigma", po::value(&options.limits.place)->default_value(0.001),
       "refuse if the distance, or a dome's centre, is known worse than this [m]")  //
      ("max-normal-sigma", po::value(&max_normal_degrees)->default_value(0.1, "0.1"),
       "refuse if the normal is known worse than this [degrees]")  //
      ("max-index-sigma", po::value(&options.limits.index)->default_value(0.005, "0.005"),
       "refuse if the water's index is known worse than this")  //
      ("max-thickness-sigma", po::value(&options.limits.thickness)->default_value(0.002),
       "refuse if the thickness is known worse than this [m]");
}

void require_positive(const char* option, double value) {
  if (!(value > 0 && std::isfinite(value))) fail("--{} {}: must be positive", option, value);
}

void check(const Options& options, double max_normal_degrees) {
  if (options.lens.empty()) fail("--lens is missing: the lens as calibrated in air");
  if (options.output.empty()) fail("--output-file is missing: the housing file to write");
  require_positive("max-error", options.calibrate.max_error);
  require_positive("max-distance-sigma", options.limits.place);
  require_positive("max-normal-sigma", max_normal_degrees);
  require_positive("max-index-sigma", options.limits.index);
  require_positive("max-thickness-sigma", options.limits.thickness);
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  Texts texts;
  double max_normal_degrees = 0;
  axial::ProgramOptions program{
      "CalibrateHousing",
      "finds the port of a housing in photographs of a board taken under water",
      {},
      {}};
  declare(program.visible, options, texts, max_normal_degrees);
  options.parsed = axial::parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  const auto path = [&](const std::string& text) {
    return axial::in_working_folder(options.parsed.common, text);
  };
  for (const std::string& input : texts.input) options.input.push_back(path(input));
  options.lens = path(texts.lens);
  options.housing = path(texts.housing);
  options.output = path(texts.output);
  options.calibmar = path(texts.calibmar);
  options.report = path(texts.report);
  options.coverage = path(texts.coverage);
  options.limits.normal = max_normal_degrees * kDegree;
  check(options, max_normal_degrees);
  if (texts.board.empty()) fail("--board is missing: what is photographed");
  try {
    options.board = axial::calibrate::parse_board(texts.board);
  } catch (const axial::Error& error) {
    fail("--board {}", error.what());
  }
  return options;
}
