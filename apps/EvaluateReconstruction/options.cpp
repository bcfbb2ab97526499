// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include <cmath>
#include <ranges>
#include <string_view>

#include "base/error.h"
#include "base/parse_number.h"

namespace po = boost::program_options;
using axial::fail, axial::parse_finite;

namespace {

// The options as text, before they are checked.
struct Texts {
  std::string input, truth, tolerance, cameras, housing, estimated;
  std::string json, error_cloud, picture, aligned, transform;
};

std::vector<double> parse_tolerances(const std::string& text) {
  const std::string wanted = "must be positive lengths in metres, separated by commas";
  if (text.empty()) fail("--tolerance is empty: {}", wanted);
  std::vector<double> values;
  for (const auto& word : std::views::split(std::string_view(text), ',')) {
    const auto value = parse_finite<double>(std::string_view(word.begin(), word.end()));
    if (!value || !(*value > 0)) fail("--tolerance {}: {}", text, wanted);
    values.push_back(*value);
  }
  return values;
}

void declare(po::options_description& visible, Options& options, Texts& texts) {
  visible.add_options()  //
      ("input-file,i", po::value(&texts.input),
       "what to evaluate: a cloud or a mesh (.ply), or a depth map (.dmap)")  //
      ("truth-file,m", po::value(&texts.truth),
       "the truth: a mesh (.ply), or for a depth map the distances along its rays (.tiff)")  //
      ("tolerance", po::value(&texts.tolerance)->default_value("0.005"),
       "distances that count as right [m], separated by commas; the first one scales histograms "
       "(to 4 times) and colours (to 2 times)")  //
      ("align", po::value(&options.align)->default_value("none"),
       "none; centres: similarity from the camera centres of --estimated to those of --cameras; "
       "icp: rigid refinement on the true mesh")  //
      ("cameras", po::value(&texts.cameras),
       "COLMAP model with the true poses: only what its views see counts as missing")     //
      ("housing", po::value(&texts.housing), "ports that those cameras look through")     //
      ("estimated", po::value(&texts.estimated), "COLMAP model the input was made with")  //
      ("samples", po::value(&options.samples)->default_value(200000),
       "points of the truth that count for completeness, about (and points of an input mesh)")  //
      ("seed", po::value(&options.seed)->default_value(1), "of the samples")                    //
      ("min-views", po::value(&options.least_views)->default_value(2),
       "views that must see a sample for it to count")  //
      ("framed-only", po::value(&options.framed_only)->default_value(false)->implicit_value(true),
       "count only points of a cloud that lie in the images of --min-views of --cameras, whatever "
       "stands in between")                                        //
      ("json", po::value(&texts.json), "write all numbers there")  //
      ("error-cloud", po::value(&texts.error_cloud),
       "write the points coloured by error (.ply)")  //
      ("picture", po::value(&texts.picture),
       "draw the errors (.png): the cloud as a camera sees it, or depth, truth and error of a "
       "map")  //
      ("picture-camera", po::value(&options.picture_camera),
       "image name in --cameras to draw from (default: the first)")  //
      ("picture-width", po::value(&options.picture_width)->default_value(1024),
       "width of a cloud's picture [pixels]")  //
      ("color-max", po::value(&options.color_max)->default_value(0),
       "error of the last colour [m] (0: twice the first tolerance)")                   //
      ("aligned", po::value(&texts.aligned), "write the input after alignment (.ply)")  //
      ("transform-out", po::value(&texts.transform),
       "write the alignment as 4 x 4 numbers, row by row");
}

void check(const Options& options) {
  if (options.truth.empty()) fail("--truth-file is missing (-m FILE)");
  if (options.align != "none" && options.align != "centres" && options.align != "icp")
    fail("--align is {}: must be none, centres or icp", options.align);
  if (options.align == "centres" && (options.estimated.empty() || options.cameras.empty()))
    fail("--align centres needs --estimated and --cameras");
  if (!options.housing.empty() && options.cameras.empty())
    fail("--housing needs --cameras: the cameras behind its ports");
  if (options.framed_only && options.cameras.empty()) fail("--framed-only needs --cameras");
  if (options.least_views == 0) fail("--min-views is 0: must be at least 1");
  if (options.samples == 0 || options.samples > 100'000'000)
    fail("--samples is {}: must be 1 to 100000000", options.samples);
  if (options.picture_width < 16 || options.picture_width > 16384)
    fail("--picture-width is {}: must be 16 to 16384", options.picture_width);
  if (!(options.color_max > 0) || !std::isfinite(options.color_max))
    fail("--color-max is {}: must be a positive length in metres", options.color_max);
  if (!options.picture_camera.empty() && options.cameras.empty())
    fail("--picture-camera needs --cameras");
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  Options options;
  Texts texts;
  axial::ProgramOptions program{
      "EvaluateReconstruction", "measures a cloud, mesh or depth map against the truth", {}, {}};
  declare(program.visible, options, texts);
  options.parsed = axial::parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  const auto path = [&](const std::string& text) {
    return axial::in_working_folder(options.parsed.common, text);
  };
  options.input = path(texts.input);
  options.truth = path(texts.truth);
  options.tolerances = parse_tolerances(texts.tolerance);
  options.cameras = path(texts.cameras);
  options.housing = path(texts.housing);
  options.estimated = path(texts.estimated);
  options.json = path(texts.json);
  options.error_cloud = path(texts.error_cloud);
  options.picture = path(texts.picture);
  options.aligned = path(texts.aligned);
  options.transform = path(texts.transform);
  if (options.color_max == 0) options.color_max = 2 * options.tolerances.front();
  check(options);
  return options;
}
