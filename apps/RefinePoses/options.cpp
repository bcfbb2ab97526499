// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <cmath>

#include "base/error.h"

namespace fs = std::filesystem;
namespace po = boost::program_options;
using axial::fail;

namespace {

void check(const Options& options) {
  if (!(options.scale_sigma > 0 && std::isfinite(options.scale_sigma)))
    fail("--scale-sigma {}: must be positive", options.scale_sigma);
  if (!(options.refine.tracks.max_error > 0))
    fail("--max-error {}: must be positive", options.refine.tracks.max_error);
  const double min_angle = options.refine.tracks.min_angle;
  if (!(min_angle >= 0 && std::isfinite(min_angle)))
    fail("--min-angle {}: must be 0 or more", min_angle);
  if (options.poses != "adjust" && options.poses != "known")
    fail("--poses {}: must be adjust or known", options.poses);
  if (options.poses == "known" && !options.scale_from.empty())
    fail("--scale-from {}: --poses known says that the model is in metres", options.scale_from);
  if (options.output.empty()) fail("--output-folder is missing");
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  std::string input, lens, housing, output;
  Options options;
  axial::pose::Sigmas& sigmas = options.sigmas;
  axial::ProgramOptions program{
      "RefinePoses",
      "turns poses that COLMAP found in photographs taken under water into refractive ones",
      {},
      {}};
  program.visible.add_options()  //
      ("input-file,i", po::value(&input),
       "COLMAP folder of the raw underwater photographs, with any lens models: the model is in "
       "DIR/sparse, DIR/sparse/0 or DIR")  //
      ("lens", po::value(&lens),
       "the lens in air: cameras.txt or cameras.bin, or a folder with it, or Calibmar's "
       "calibration.yaml; by camera id, or one for all; a model of COLMAP-Underwater has it")  //
      ("housing", po::value(&housing),
       "housing file: ports the cameras look through; a model of COLMAP-Underwater has them, and "
       "Calibmar's file")  //
      ("output-folder,o", po::value(&output),
       "folder for sparse/ (COLMAP text, lens in air), housing.json and report.json")  //
      ("poses", po::value(&options.poses)->default_value("adjust"),
       "adjust, or known: they are right and in metres, and stay; points are placed, and what "
       "--refine names is adjusted")  //
      ("refine", po::value(&options.refine_list)->default_value(""),
       "what else is unknown: any of normal, distance (flat ports), centre (domes), thickness (of "
       "the "
       "glass), index (of the water), focal")(
          "normal-sigma", po::value(&sigmas.normal_degrees)->default_value(0),
          "how well the normal was measured [degrees]; 0: not at all")(
          "distance-sigma", po::value(&sigmas.distance)->default_value(0), "the distance [m]")(
          "centre-sigma", po::value(&sigmas.centre)->default_value(0), "a dome's centre [m]")(
          "thickness-sigma", po::value(&sigmas.thickness)->default_value(0),
          "the thickness of the glass [m]")(
          "index-sigma", po::value(&sigmas.index)->default_value(0), "the water's index")(
          "focal-sigma", po::value(&sigmas.focal)->default_value(0), "focal lengths, relative")(
          "scale-from", po::value(&options.scale_from),
          "what is known in metres: images:NAME,NAME,METRES or points:ID,ID,METRES or "
          "positions:FILE with a line NAME X Y Z for each image; without it refraction alone tells "
          "the scale, weakly")("scale-sigma", po::value(&options.scale_sigma)->default_value(0.001),
                               "how well that is known [m]")(
          "max-error", po::value(&options.refine.tracks.max_error)->default_value(4),
          "observations with larger errors are dropped [px]")(
          "colmap-underwater", po::value(&options.underwater)->default_value(false),
          "also write colmap-underwater/, the model with its ports for COLMAP-Underwater")(
          "min-angle", po::value(&options.refine.tracks.min_angle)->default_value(1.5),
          "points seen under smaller angles are dropped [degrees]");
  options.parsed = axial::parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  const axial::CommonOptions& common = options.parsed.common;
  options.model = axial::in_working_folder(common, input);
  options.lens = axial::in_working_folder(common, lens);
  options.housing = axial::in_working_folder(common, housing);
  options.output = axial::in_working_folder(common, output);
  check(options);
  return options;
}
