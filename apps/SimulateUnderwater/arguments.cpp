// SPDX-License-Identifier: GPL-3.0-or-later
#include "arguments.h"

#include <sstream>
#include <vector>

#include "base/error.h"
#include "base/parse_number.h"
#include "base/split.h"
#include "base/version.h"

namespace axial::apps {
namespace {

std::vector<double> lengths_of(const std::string& text) {
  std::vector<double> lengths;
  for (const std::string_view word : split(text, ',')) {
    const auto length = parse_finite<double>(word);
    if (!length || !(*length > 0)) fail("--bars {}: '{}' is not a length above 0", text, word);
    lengths.push_back(*length);
  }
  return lengths;
}

void declare_scene(OptionList& visible, Arguments& a) {
  visible
      .add_with_default("preset", &a.preset.name,
                        "reef, outcrop, closeup, survey, thicket, sand, transect or amphora; "
                        "NAME-hazy: with haze 6/7")
      .add_with_default("seed", &a.preset.seed, "seed of all random numbers")
      .add("output,o", &a.output, "folder of the scene (required)")
      .output_folder()
      .add_with_default("views", &a.preset.views, "number of images (0: the preset's number)")
      .add_with_default("width", &a.preset.width, "width of the images [px]")
      .add_with_default("height", &a.preset.height, "height of the images [px]")
      .add_with_default("fov-degrees", &a.preset.horizontal_fov_degrees,
                        "horizontal field of view in air, without the lens's distortion")
      .add("lens", &a.lens, "distorted lens: OPENCV,k1,k2,p1,p2 or OPENCV_FISHEYE,k1,k2,k3,k4")
      .add_with_default("scale", &a.preset.scale,
                        "scale of the scene and of the views' distances, not of the port")
      .add_with_default("coarseness", &a.preset.coarseness,
                        "factor for the distance between the vertices of the mesh")
      .add_with_default("relief", &a.preset.relief, "factor for the scene's heights")
      .add_with_default("overlap", &a.preset.overlap,
                        "share of its ground that a view of transect has in common with the next")
      .range(0, 0.95)
      .add_switch("changed", &a.preset.changed,
                  "a second survey of the reef: a boulder moved, a patch of 1 m x 1 m grew by 20 "
                  "mm, and the views and the noise are others; plates stay; writes change.json")
      .add_with_default("samples", &a.samples, "rays along each side of a pixel")
      .range(1, 16)
      .add_with_default("sparse-points", &a.sparse_points,
                        "sparse points of the COLMAP model that are placed for each view")
      .range(1, 10000);
}

void declare_targets(OptionList& visible, Arguments& a) {
  visible
      .add_with_default("targets", &a.targets,
                        "plates with coded targets on the ground; writes true_targets.json")
      .range(0, 1000)
      .add_with_default("target-family", &a.target_family,
                        "the targets' family, as FindTargets names it")
      .add_with_default("target-side", &a.target_side, "side of the plates [m]")
      .range(0.01, 10)
      .add_text(
          "bars", [&](const std::string& text) { a.bars = lengths_of(text); },
          "scale bars, each of two more plates, by the distances of their centres [m]: 0.5,0.5");
}

void declare_port(OptionList& visible, Arguments& a) {
  visible.add("port-distance", &a.port_distance, "camera centre to glass [m]")
      .add("port-thickness", &a.port_thickness, "thickness of the glass [m]")
      .add("tilt-degrees", &a.tilt_degrees, "tilt of the port against the optical axis")
      .range(-45, 45)
      .add("water-level", &a.water_level,
           "height of a water surface below cameras in air, which replaces the port [m]")
      .add("dome-radius", &a.dome_radius,
           "inner radius of a dome, which replaces the flat port [m]")
      .add_with_default("dome-x", &a.dome_x, "x: camera centre to dome centre [m]")
      .add_with_default("dome-y", &a.dome_y, "y: camera centre to dome centre [m]")
      .add_with_default("dome-z", &a.dome_z, "z: camera centre to dome centre [m]")
      .add("n-glass", &a.n_glass, "refractive index of the glass")
      .add("n-water", &a.n_water, "refractive index of the water")
      .add(
          "rig-base", &a.second_camera.base,
          "second camera to the right of each view, by this distance [m]; photographs are in left/ "
          "and right/")
      .range(0.001, 100)
      .add_with_default("rig-port-distance", &a.second_camera.port_distance,
                        "camera centre to glass of the second camera [m]")
      .add_with_default("rig-delay", &a.second_camera.delay,
                        "how much later the second camera takes its photographs, in intervals "
                        "between photographs")
      .range(-1, 1);
}

void declare_photographs(OptionList& visible, Arguments& a) {
  visible
      .add("haze", &a.haze,
           "share of the light that the medium, water or air, scatters into view, 0 to 1 (default: "
           "the preset's value, which is 0 except for NAME-hazy)")
      .range(0, 1)
      .add("water", &a.water,
           "light that water changes by wavelength, of Jerlov's type I, IA, IB, II, III, 1C, 3C, "
           "5C, "
           "7C or 9C; writes light.json and the surface's colours. Nine numbers: plain water, "
           "J exp(-a d) + B (1 - exp(-b d)), with a, b and B each for R,G,B")
      .add_with_default("light", &a.light, "with --water: sun, lamp or lamp:FILE")
      .add_with_default("depth", &a.depth,
                        "with --water: depth of the scene's z = 0 below the water's surface [m]")
      .range(0, 200)
      .add("scattering", &a.scattering,
           "with --water: scattering at 550 nm [1/m] (default: usual for the type)")
      .range(0, 20)
      .add_with_default("exposure-stops", &a.exposure_stops,
                        "with --water: exposures of the photographs differ at random by up to this "
                        "number of stops from the right one")
      .range(0, 4)
      .add_with_default("response", &a.response,
                        "with --water: how the camera maps light to values: linear, srgb or camera "
                        "(srgb with more contrast)")
      .one_of({"linear", "srgb", "camera"})
      .add_with_default("noise", &a.noise, "standard deviation of the noise [grey levels]")
      .range(0, 255)
      .add_with_default("jpeg-quality", &a.jpeg_quality, "JPEG quality, 1 to 100")
      .range(1, 100)
      .add_with_default("truth", &a.truth, "write distances and normals of the images")
      .add_switch("truth-only", &a.truth_only, "write only mesh.ply, distances and normals")
      .add_with_default("medium", &a.medium, "air, water or both")
      .one_of({"air", "water", "both"});
}

}  // namespace

ProgramOptions describe(Arguments& a) {
  ProgramOptions program;
  program.name = "SimulateUnderwater";
  program.version = version_line(program.name);
  program.description = "makes a synthetic scene with ground truth, in air and under water";
  // In the order of --help.
  declare_scene(program.visible, a);
  declare_targets(program.visible, a);
  declare_port(program.visible, a);
  declare_photographs(program.visible, a);
  return program;
}

void check(const Arguments& a, const ParsedOptions& parsed) {
  if (a.truth_only && !a.truth) fail("--truth-only contradicts --truth 0");
  for (const char* of_water : {"light", "depth", "scattering", "exposure-stops", "response"})
    if (given(parsed, of_water) && a.water.empty()) fail("--{} needs --water", of_water);
  const bool plain = a.water.find(',') != std::string::npos;
  for (const char* of_spectrum : {"light", "depth", "scattering"})
    if (given(parsed, of_spectrum) && plain)
      fail("--{} contradicts --water with nine numbers", of_spectrum);
  if (given(parsed, "depth") && a.light != "sun") fail("--depth contradicts --light {}", a.light);
  if (!a.water.empty() && a.preset.name.ends_with("-hazy"))
    fail("--preset {} contradicts --water", a.preset.name);
  for (const char* without : {"haze", "water-level", "truth-only", "rig-base"})
    if (given(parsed, without) && !a.water.empty()) fail("--{} contradicts --water", without);
  if (!a.water.empty() && a.medium == "air") fail("--water contradicts --medium air");
  if (a.output.empty()) fail("no output folder given (-o DIR)");
}

void apply_lens_option(simulate::Preset& preset, const Arguments& a) {
  if (a.lens.empty()) return;
  std::vector<std::string> parts;
  std::istringstream text(a.lens);
  for (std::string part; std::getline(text, part, ',');) parts.push_back(part);
  simulate::Bend bend;
  bend.fisheye = parts[0] == "OPENCV_FISHEYE";
  if (!bend.fisheye && parts[0] != "OPENCV")
    fail("--lens is '{}': must begin with OPENCV or OPENCV_FISHEYE", a.lens);
  if (parts.size() != bend.k.size() + 1)
    fail("--lens is '{}': must have {} coefficients", a.lens, bend.k.size());
  for (std::size_t i = 0; i < bend.k.size(); ++i) {
    const auto number = parse_finite<double>(parts[i + 1]);
    if (!number) fail("--lens is '{}': '{}' is not a number", a.lens, parts[i + 1]);
    bend.k[i] = *number;
  }
  preset.lens.bend = bend;
  simulate::check_lens(preset.lens);
}

void apply_port_options(simulate::Preset& preset, const Arguments& a, const ParsedOptions& parsed) {
  simulate::Port& port = preset.port;
  const bool surface = given(parsed, "water-level");
  for (const char* of_housing :
       {"port-distance", "port-thickness", "tilt-degrees", "dome-radius", "n-glass"})
    if (surface && given(parsed, of_housing))
      fail("--{} is for a housing, but with --water-level the cameras are in air without a housing",
           of_housing);
  if (surface) preset.water_level = a.water_level;
  if (given(parsed, "port-distance")) port.distance = a.port_distance;
  if (given(parsed, "port-thickness")) port.thickness = a.port_thickness;
  if (given(parsed, "tilt-degrees")) port.normal = simulate::tilted_normal(a.tilt_degrees);
  const bool dome = given(parsed, "dome-radius");
  for (const char* of_flat : {"port-distance", "tilt-degrees"})
    if (dome && given(parsed, of_flat))
      fail("--{} is for a flat port, but --dome-radius makes a dome", of_flat);
  for (const char* of_dome : {"dome-x", "dome-y", "dome-z"})
    if (!dome && given(parsed, of_dome)) fail("--{} needs --dome-radius", of_dome);
  for (const char* of_rig : {"rig-port-distance", "rig-delay"})
    if (given(parsed, of_rig) && !given(parsed, "rig-base")) fail("--{} needs --rig-base", of_rig);
  if (dome) port.dome = simulate::Dome{{a.dome_x, a.dome_y, a.dome_z}, a.dome_radius};
  if (given(parsed, "n-glass")) port.n_glass = a.n_glass;
  if (given(parsed, "n-water")) port.n_water = a.n_water;
}

}  // namespace axial::apps
