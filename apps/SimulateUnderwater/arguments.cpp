// SPDX-License-Identifier: GPL-3.0-or-later
#include "arguments.h"

#include <cmath>
#include <sstream>
#include <vector>

#include "base/error.h"
#include "base/parse_number.h"

namespace axial {
namespace po = boost::program_options;

ProgramOptions describe(Arguments& a) {
  ProgramOptions program;
  program.name = "SimulateUnderwater";
  program.description = "makes a synthetic scene with ground truth, in air and under water";
  const simulate::PresetOptions preset;
  program.visible.add_options()("preset", po::value(&a.preset.name)->default_value(preset.name),
                                "reef, outcrop, closeup or survey")(
      "seed", po::value(&a.preset.seed)->default_value(preset.seed), "of everything random")(
      "output,o", po::value(&a.output), "folder of the scene (required)")(
      "views", po::value(&a.preset.views)->default_value(0), "images (0: the preset's number)")(
      "width", po::value(&a.preset.width)->default_value(preset.width), "of the images [px]")(
      "height", po::value(&a.preset.height)->default_value(preset.height), "of the images [px]")(
      "fov-degrees",
      po::value(&a.preset.horizontal_fov_degrees)->default_value(preset.horizontal_fov_degrees),
      "horizontal field of view in air, without the lens's distortion")(
      "lens", po::value(&a.lens),
      "a distorted one: OPENCV,k1,k2,p1,p2 or OPENCV_FISHEYE,k1,k2,k3,k4")(
      "scale", po::value(&a.preset.scale)->default_value(preset.scale),
      "of the scene and the views' distances, not of the port")(
      "coarseness", po::value(&a.preset.coarseness)->default_value(preset.coarseness),
      "of the mesh: the distance between its vertices times this")(
      "relief", po::value(&a.preset.relief)->default_value(preset.relief),
      "of the scene's heights")("samples", po::value(&a.samples)->default_value(3),
                                "rays along each side of a pixel")(
      "port-distance", po::value(&a.port_distance), "camera centre to glass [m]")(
      "port-thickness", po::value(&a.port_thickness), "of the glass [m]")(
      "tilt-degrees", po::value(&a.tilt_degrees), "of the port against the optical axis")(
      "water-level", po::value(&a.water_level),
      "height of a water surface that cameras in the air look through, in place of a port [m]")(
      "dome-radius", po::value(&a.dome_radius),
      "inner radius of a dome in place of the flat port [m]")(
      "dome-x", po::value(&a.dome_x)->default_value(0), "camera centre to dome centre [m]")(
      "dome-y", po::value(&a.dome_y)->default_value(0), "camera centre to dome centre [m]")(
      "dome-z", po::value(&a.dome_z)->default_value(0), "camera centre to dome centre [m]")(
      "n-glass", po::value(&a.n_glass), "refractive index")("n-water", po::value(&a.n_water),
                                                            "refractive index")(
      "haze", po::value(&a.haze)->default_value(0),
      "share of the light that the medium, water or air, scatters into view, 0 to 1")(
      "noise", po::value(&a.noise)->default_value(1.2), "standard deviation [grey levels]")(
      "jpeg-quality", po::value(&a.jpeg_quality)->default_value(93), "1 to 100")(
      "truth", po::value(&a.truth)->default_value(true),
      "write distances and normals of the images")(
      "truth-only", po::value(&a.truth_only)->default_value(false)->implicit_value(true),
      "write mesh.ply, distances and normals, nothing else")(
      "medium", po::value(&a.medium)->default_value("both"), "air, water or both");
  return program;
}

void check(const Arguments& a) {
  if (a.truth_only && !a.truth) fail("--truth-only contradicts --truth 0");
  if (a.output.empty()) fail("no output folder given (-o DIR)");
  if (a.medium != "air" && a.medium != "water" && a.medium != "both")
    fail("--medium is '{}': must be air, water or both", a.medium);
  if (!(a.haze >= 0 && a.haze <= 1)) fail("--haze is {}: must be between 0 and 1", a.haze);
  if (!(a.noise >= 0 && a.noise <= 255)) fail("--noise is {}: must be between 0 and 255", a.noise);
  if (a.jpeg_quality < 1 || a.jpeg_quality > 100)
    fail("--jpeg-quality is {}: must be between 1 and 100", a.jpeg_quality);
  if (a.samples < 1 || a.samples > 16) fail("--samples is {}: must be between 1 and 16", a.samples);
  if (!(std::abs(a.tilt_degrees) <= 45))
    fail("--tilt-degrees is {}: must be between -45 and 45", a.tilt_degrees);
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
    if (!number) fail("--lens is '{}': '{}' is no number", a.lens, parts[i + 1]);
    bend.k[i] = *number;
  }
  preset.lens.bend = bend;
  simulate::check_lens(preset.lens);
}

void apply_port_options(simulate::Preset& preset, const Arguments& a,
                        const po::variables_map& values) {
  simulate::Port& port = preset.port;
  const bool surface = given(values, "water-level");
  for (const char* of_housing :
       {"port-distance", "port-thickness", "tilt-degrees", "dome-radius", "n-glass"})
    if (surface && given(values, of_housing))
      fail("--{} is of a housing, and --water-level puts the cameras in the air", of_housing);
  if (surface) preset.water_level = a.water_level;
  if (given(values, "port-distance")) port.distance = a.port_distance;
  if (given(values, "port-thickness")) port.thickness = a.port_thickness;
  if (given(values, "tilt-degrees")) port.normal = simulate::tilted_normal(a.tilt_degrees);
  const bool dome = given(values, "dome-radius");
  for (const char* of_flat : {"port-distance", "tilt-degrees"})
    if (dome && given(values, of_flat))
      fail("--{} is of a flat port, and --dome-radius makes a dome", of_flat);
  for (const char* of_dome : {"dome-x", "dome-y", "dome-z"})
    if (!dome && given(values, of_dome)) fail("--{} needs --dome-radius", of_dome);
  if (dome) port.dome = simulate::Dome{{a.dome_x, a.dome_y, a.dome_z}, a.dome_radius};
  if (given(values, "n-glass")) port.n_glass = a.n_glass;
  if (given(values, "n-water")) port.n_water = a.n_water;
}

}  // namespace axial
