// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <algorithm>
#include <numbers>
#include <sstream>
#include <vector>

#include "base/error.h"

namespace fs = std::filesystem;
namespace po = boost::program_options;
using axial::fail;

namespace {

using axial::pose::AdjustOptions;

constexpr double kDegree = std::numbers::pi / 180;

// "normal,index" -> numbers 0, 1 and 3 of housing_change.h.
void set_free(const std::string& list, AdjustOptions& adjust) {
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, ',');) {
    if (word == "normal")
      adjust.free[0] = adjust.free[1] = true;
    else if (word == "distance")
      adjust.free[2] = true;
    else if (word == "centre" || word == "center")
      adjust.free[0] = adjust.free[1] = adjust.free[2] = true;
    else if (word == "index")
      adjust.free[axial::pose::kIndexNumber] = true;
    else if (word == "focal")
      adjust.free[axial::pose::kFocalNumber] = true;
    else
      fail("--refine {}: '{}' is none of normal, distance, centre, index, focal", list, word);
  }
}

struct Sigmas {
  double normal_degrees, distance, centre, index, focal;
};

void set_sigmas(const Sigmas& sigmas, bool dome, AdjustOptions& adjust) {
  auto& prior = adjust.prior_sigma;
  prior[0] = prior[1] = dome ? sigmas.centre : sigmas.normal_degrees * kDegree;
  prior[2] = dome ? sigmas.centre : sigmas.distance;
  prior[axial::pose::kIndexNumber] = sigmas.index;
  prior[axial::pose::kFocalNumber] = sigmas.focal;
}

void check_not_negative(const std::string& option, double value) {
  if (!(value >= 0)) fail("--{} {}: must be 0 or more", option, value);
}

void check(const Options& options, const Sigmas& sigmas) {
  check_not_negative("normal-sigma", sigmas.normal_degrees);
  check_not_negative("distance-sigma", sigmas.distance);
  check_not_negative("centre-sigma", sigmas.centre);
  check_not_negative("index-sigma", sigmas.index);
  check_not_negative("focal-sigma", sigmas.focal);
  if (!(options.scale_sigma > 0)) fail("--scale-sigma {}: must be positive", options.scale_sigma);
  if (!(options.refine.tracks.max_error > 0))
    fail("--max-error {}: must be positive", options.refine.tracks.max_error);
  check_not_negative("min-angle", options.refine.tracks.min_angle);
  if (options.lens.empty()) fail("--lens is missing: the lens as calibrated in air");
  if (options.housing.empty()) fail("--housing is missing: the port that the camera looks through");
  if (options.output.empty()) fail("--output-folder is missing");
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  std::string input, lens, housing, output, refine;
  Sigmas sigmas{};
  Options options;
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
       "the lens in air: cameras.txt or cameras.bin, or a folder with it; by camera id, or one for "
       "all")                                                                           //
      ("housing", po::value(&housing), "housing file: ports the cameras look through")  //
      ("output-folder,o", po::value(&output),
       "folder for sparse/ (COLMAP text, lens in air), housing.json and report.json")  //
      ("refine", po::value(&refine)->default_value(""),
       "what else is unknown: any of normal, distance (flat ports), centre (domes), index, focal")(
          "normal-sigma", po::value(&sigmas.normal_degrees)->default_value(0),
          "how well the normal was measured [degrees]; 0: not at all")(
          "distance-sigma", po::value(&sigmas.distance)->default_value(0), "the distance [m]")(
          "centre-sigma", po::value(&sigmas.centre)->default_value(0), "a dome's centre [m]")(
          "index-sigma", po::value(&sigmas.index)->default_value(0), "the water's index")(
          "focal-sigma", po::value(&sigmas.focal)->default_value(0), "focal lengths, relative")(
          "scale-from", po::value(&options.scale_from),
          "what is known in metres: images:NAME,NAME,METRES or points:ID,ID,METRES or "
          "positions:FILE with a line NAME X Y Z for each image; without it refraction alone tells "
          "the scale, weakly")("scale-sigma", po::value(&options.scale_sigma)->default_value(0.001),
                               "how well that is known [m]")(
          "max-error", po::value(&options.refine.tracks.max_error)->default_value(4),
          "observations with larger errors are dropped [px]")(
          "min-angle", po::value(&options.refine.tracks.min_angle)->default_value(1.5),
          "points seen under smaller angles are dropped [degrees]");
  options.parsed = axial::parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  const axial::CommonOptions& common = options.parsed.common;
  options.model = axial::in_working_folder(common, input);
  options.lens = axial::in_working_folder(common, lens);
  options.housing = axial::in_working_folder(common, housing);
  options.output = axial::in_working_folder(common, output);
  check(options, sigmas);
  AdjustOptions& adjust = options.refine.adjust;
  set_free(refine, adjust);
  set_sigmas(sigmas, refine.find("cent") != std::string::npos, adjust);
  return options;
}
