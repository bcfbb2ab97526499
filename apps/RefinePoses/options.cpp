// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include "base/error.h"
#include "base/program/unused_input.h"
#include "base/version.h"
#include "usual_housing.h"

namespace axial::apps {
namespace {

void check_effective_lens(const Options& options) {
  for (const char* other : {"input-file", "output-folder", "scale-from", "scale-sigma", "refine",
                            "database", "targets", "images", "bars", "control", "checks", "epsg",
                            "rig", "rig-poses", "rig-frames", "rig-times", "rig-interval"})
    if (given(options.parsed, other))
      fail("--effective-lens {}: contradicts --{}", options.effective_lens.string(), other);
  if (options.lens.empty()) fail("--lens is missing: the lens calibrated in air");
  if (options.housing.empty() && options.usual_housing.empty())
    fail("--housing is missing: the port of the camera");
}

void check(const Options& options) {
  if (!options.effective_lens.empty()) return check_effective_lens(options);
  if (given(options.parsed, "scene-distance"))
    fail("--scene-distance {}: is for --effective-lens", options.scene_distance);
  if (options.poses == "known" && !options.scale_from.empty())
    fail("--scale-from {}: contradicts --poses known, which means that the model is in metres",
         options.scale_from);
  if (options.scale_from.empty() && options.scale_sigma.given)
    fail("--scale-sigma {}: is the standard deviation of --scale-from, which is missing",
         options.scale_sigma.metres);
  check(options.control);
  check_rigs(options.rigs);
  if (options.output.empty()) fail("--output-folder is missing");
}

void declare_files(OptionList& visible, Options& options, std::string& housing) {
  visible
      .add("input-file,i", &options.model,
           "COLMAP folder of the raw underwater photographs, with any camera models: the model is "
           "in DIR/sparse, DIR/sparse/0 or DIR")
      .add("lens", &options.lens,
           "lens calibrated in air: cameras.txt or cameras.bin, a folder with this file, or "
           "Calibmar's calibration.yaml; lenses by camera id, or one lens for all cameras; a model "
           "of COLMAP-Underwater contains it")
      .add("housing", &housing,
           "housing file with the ports of the cameras; a model of COLMAP-Underwater and "
           "Calibmar's file contain them; flat, dome or unknown: usual numbers, which the "
           "photographs "
           "correct")
      .add("output-folder,o", &options.output,
           "folder for sparse/ (COLMAP text, lens in air), housing.json and report.json")
      .output_folder()
      .add("database", &options.database,
           "COLMAP's database of these photographs: photographs to which COLMAP gave no pose get "
           "one if their matches determine it, and observations are weighed by the sizes of their "
           "features")
      .add("effective-lens", &options.effective_lens,
           "instead of refining poses, write this cameras.txt: the single lens that images nearly "
           "as "
           "the lens in air behind its port, for COLMAP to start with")
      .output_file()
      .add_with_default("scene-distance", &options.scene_distance,
                        "distance of the scene for --effective-lens [m]")
      .positive();
}

// What is estimated, from which observations, and what is known.
void declare_estimate(OptionList& visible, Options& options, std::string& targets) {
  visible
      .add_with_default("poses", &options.poses,
                        "adjust, or known: the poses are correct and in metres, and are kept; only "
                        "the points and the values of --refine are estimated")
      .one_of({"adjust", "known"})
      .sets("poses_known", " known")
      .add_with_default(
          "refine", &options.refine_list,
          "values of lens and port to estimate: auto, none, or a list of normal, "
          "distance (flat ports), centre (domes), thickness (of the glass), index "
          "(of the water), focal; auto: all but a thickness of unknown accuracy, each "
          "near its stated value as far as its standard deviation says, and none with "
          "--poses known");
  pose::declare_sigmas(visible, options.sigmas);
  visible
      .add_with_default("focal-sigma", &options.sigmas.focal,
                        "standard deviation of the focal lengths, relative")
      .add("scale-from", &options.scale_from,
           "known lengths or positions in metres: images:NAME,NAME,METRES (names with commas in "
           "double quotes) or points:ID,ID,METRES or positions:FILE with a line NAME X Y Z for "
           "each image (names may contain blanks), or a file of Metashape, Pix4D, OpenDroneMap or "
           "a spreadsheet; without it, only refraction determines the scale, with low precision")
      .sets("distances")
      .add_with_default("scale-sigma", &options.scale_sigma.metres,
                        "standard deviation of the lengths or positions of --scale-from [m]; "
                        "without this option, that of positions is estimated from their distances "
                        "to the cameras, unless their file states it")
      .positive()
      .add("targets", &targets,
           "targets in the photographs: a file of FindTargets, gcp_list.txt of OpenDroneMap, or "
           "markers of Metashape (XML); or find: they are found in the photographs of --images")
      .add("images", &options.control.images, "folder of the photographs, for --targets find")
      .add_with_default("families", &options.control.families,
                        "families of targets for --targets find, as for FindTargets")
      .add("bars", &options.control.bars,
           "known distances between targets: lines TARGET,TARGET,METRES,SIGMA, or JSON")
      .add("control", &options.control.control,
           "known coordinates of targets, or of cameras by the names of photographs: a table of "
           "ReefShape or Metashape, gcp_list.txt, or JSON; coordinates may be missing, for example "
           "all but depths")
      .add("checks", &options.control.checks,
           "labels of targets and bars (TARGET-TARGET), separated by commas, that do not enter the "
           "adjustment: their errors are reported")
      .add(
          "epsg", &options.control.epsg,
          "code of the system to which longitudes and latitudes of --control are transformed, with "
          "metres as unit; default: the UTM zone of their mean")
      .at_least(1)
      .add_with_default(
          "weight-by-radius", &options.refine.weigh_by_radius,
          "observations at the rim of photographs weigh less if their errors are larger, "
          "as behind flat ports")
      .add_with_default("max-error", &options.refine.tracks.max_error,
                        "observations with larger errors are dropped [px]")
      .positive()
      .add_with_default(
          "colmap-underwater", &options.underwater,
          "also write colmap-underwater/, the model with its ports for COLMAP-Underwater")
      .add_with_default("min-angle", &options.refine.tracks.min_angle,
                        "points seen under smaller angles are dropped [degrees]")
      .at_least(0);
}

}  // namespace

Options parse_command_line(int argc, const char* const* argv) {
  std::string housing, targets;
  Options options;
  ProgramOptions program{
      "RefinePoses",
      "computes refractive poses from the poses that COLMAP found for photographs under water",
      {},
      {}};
  program.version = version_line(program.name);
  program.instead_of_input = "effective-lens";
  // In the order of --help.
  declare_files(program.visible, options, housing);
  declare_estimate(program.visible, options, targets);
  declare_rigs(program.visible, options.rigs);
  UnusedInput::declare(program.visible, options.allow_missing);
  options.parsed = parse_options(argc, argv, program);
  if (!options.parsed.run) return options;
  if (is_usual_housing(housing))
    options.usual_housing = housing;
  else
    options.housing = in_working_folder(options.parsed.common, housing);
  options.control.find = targets == "find";
  if (!targets.empty() && !options.control.find)
    options.control.targets = in_working_folder(options.parsed.common, targets);
  options.scale_sigma.given = given(options.parsed, "scale-sigma");
  check(options);
  return options;
}

}  // namespace axial::apps
